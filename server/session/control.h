// Who may change a session: one at a time by a token with a time to live, or everybody.
#ifndef PHRENIC_SERVER_SESSION_CONTROL_H_
#define PHRENIC_SERVER_SESSION_CONTROL_H_

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "phrenic/v1/access.pb.h"
#include "phrenic/v1/control.pb.h"

namespace phrenic::session {

// All that there is to know about control, so that it can be kept and given back.
struct ControlState {
  struct Person {
    std::string name;
    std::string token;
    absl::Duration time_to_live;
    absl::Time expires = absl::InfinitePast();  // is forgotten then; of the owner: counts as away, and stays the owner
    bool asks = false;
  };
  // Of a join link; whoever has its secret may do as its role says.
  struct Link {
    std::string id;
    std::string secret_sha256;
    v1::AccessRole role = v1::ACCESS_ROLE_VIEWER;
    absl::Time expires;
    std::string made_by;  // an account
  };
  v1::ControlPolicy policy = v1::CONTROL_POLICY_EVERYBODY;  // while `holder` is empty
  Person owner;
  std::vector<Person> people;  // who entered, but the owner
  std::string holder;          // the token of the one of them who has control; empty: none
  std::int64_t revision = 1;
  // On a server with accounts: whom the session belongs to; empty: everybody who has an account may see it.
  std::string account;
  std::vector<Link> links;
};

// At any moment one person controls, or everybody does: the holder while they stay, else as the policy says. The owner
// may take control from any holder. Not thread-safe: the stepping thread has it. `now` never goes back.
class ControlBook {
 public:
  // Everybody controls, and nobody owns it.
  ControlBook() = default;
  // As it was kept.
  explicit ControlBook(ControlState state) : state_(std::move(state)) {}
  // A new session's: the owner has not entered. INVALID_ARGUMENT for a name that is none (CheckName).
  static absl::StatusOr<ControlBook> Make(v1::ControlPolicy policy, const std::string& owner,
                                          const std::string& account = "");

  const ControlState& state() const { return state_; }
  // For everybody: nothing of it is secret.
  v1::Control Describe(absl::Time now) const;

  // OK where whoever has this token may change the session, which keeps them there; else PERMISSION_DENIED says who
  // controls it, until when, and what to do.
  absl::Status Check(std::string_view token, absl::Time now);
  // OK where this token's bearer, and nobody else, controls.
  absl::Status CheckAlone(std::string_view token, absl::Time now);

  // The token of whoever has entered: the given one where it is known. INVALID_ARGUMENT, ALREADY_EXISTS of the name,
  // RESOURCE_EXHAUSTED where too many have.
  absl::StatusOr<std::string> Enter(const std::string& name, std::string_view token, absl::Duration time_to_live,
                                    absl::Time now);
  // Whether control was granted; the bearer asks for it otherwise.
  absl::StatusOr<bool> Take(std::string_view token, absl::Time now);
  // FAILED_PRECONDITION where nobody has entered under that name.
  absl::Status Hand(std::string_view token, const std::string& name, absl::Time now);
  absl::Status HandToEverybody(std::string_view token, absl::Time now);
  absl::Status Release(std::string_view token, absl::Time now);

  // A link for as long as it says, and none that has ended is kept. RESOURCE_EXHAUSTED past 64.
  absl::Status AddLink(ControlState::Link link, absl::Time now);
  // NOT_FOUND where there is no such link.
  absl::Status RemoveLink(const std::string& id);

  // Forgets whose time is over; whether there was one.
  bool Expire(absl::Time now);
  // When the next one's will be.
  absl::Time next_expiry() const;

 private:
  using Person = ControlState::Person;

  bool IsOwner(std::string_view token) const;
  Person* Find(std::string_view token);
  const Person* Holder() const;
  // Control is this token's bearer's, or as the policy says; something of it changed in any case.
  void GiveTo(std::string holder);
  // Who has entered with this token, or PERMISSION_DENIED; their time begins anew.
  absl::StatusOr<Person*> Known(std::string_view token, absl::Time now);
  // The same, and they control alone or own the session.
  absl::StatusOr<Person*> KnownToDecide(std::string_view token, absl::Time now);
  absl::Status CheckFree(const std::string& name, const Person* self, absl::Time now) const;
  absl::Status Refuse(absl::Time now) const;

  ControlState state_;
};

// INVALID_ARGUMENT unless it is 1 to 40 characters, none of them a control character or at the ends a space.
absl::Status CheckName(const std::string& field, const std::string& name);

inline constexpr std::size_t kMostPeople = 256;
inline constexpr std::size_t kMostLinks = 64;

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_CONTROL_H_
