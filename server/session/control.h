// Who may change a session: everybody, or one person at a time, by a token with a time to live.
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

// The whole of a session's control, as it is saved and restored.
struct ControlState {
  struct Person {
    std::string name;                           // 1 to 40 characters (CheckName), unique in the session
    std::string token;                          // 128 random bits (NewToken), known to this person alone
    absl::Duration time_to_live;                // from each renewal to `expires`
    absl::Time expires = absl::InfinitePast();  // removed then; the owner is away then, and stays the owner
    bool asks = false;                          // for control
  };
  // A join link: its secret gives its role to any bearer.
  struct Link {
    std::string id;  // public, names it in RemoveLink
    std::string secret_sha256;
    v1::AccessRole role = v1::ACCESS_ROLE_VIEWER;
    absl::Time expires;   // removed by the next AddLink after it
    std::string made_by;  // account
  };
  v1::ControlPolicy policy = v1::CONTROL_POLICY_EVERYBODY;  // while `holder` is empty
  Person owner;
  std::vector<Person> people;  // who have entered, without the owner
  std::string holder;          // token of the person of `people` who controls; empty: none of them
  std::int64_t revision = 1;   // grows with every change, but not when a time is renewed
  // On a server with accounts: the account that owns the session; empty: every account may see it.
  std::string account;
  std::vector<Link> links;
};

// At any time one person controls, or everybody does: the holder until they expire, otherwise as the policy says. The
// owner may take control from any holder. Not thread-safe: the stepping thread owns it. Requires: `now` never decreases
// between calls. Take, Hand, HandToEverybody and Release return PERMISSION_DENIED if no person in the session has the
// token. Each call with a person's token renews their time, except for the owner, whose time only Enter renews.
class ControlBook {
 public:
  // Everybody controls; there is no owner.
  ControlBook() = default;
  // Restores saved control. The next Expire removes people whose time has passed.
  explicit ControlBook(ControlState state) : state_(std::move(state)) {}
  // Makes the control of a new session, whose owner has not entered yet. The errors of CheckName. An empty owner's name
  // becomes "owner", an unspecified policy CONTROL_POLICY_EVERYBODY. `account` owns the session on a server with
  // accounts.
  static absl::StatusOr<ControlBook> Make(v1::ControlPolicy policy, const std::string& owner,
                                          const std::string& account = "");

  const ControlState& state() const { return state_; }
  // Returns what every client may know: no tokens.
  v1::Control Describe(absl::Time now) const;

  // Returns OK if the token's bearer may change the session, and renews their time; otherwise PERMISSION_DENIED says
  // who controls it, until when, and what to do. While everybody controls, an unknown or empty token is good as well.
  absl::Status Check(std::string_view token, absl::Time now);
  // Returns OK if the token's bearer alone controls the session. PERMISSION_DENIED also while everybody controls.
  absl::Status CheckAlone(std::string_view token, absl::Time now);

  // Enters a person and returns their token: the given one if it is known, else a new one. INVALID_ARGUMENT for a bad
  // name, ALREADY_EXISTS for a taken one, RESOURCE_EXHAUSTED past kMostPeople. The name of an owner who is away counts
  // as taken. Enter again renews the time, and may change the name; an empty name keeps it.
  absl::StatusOr<std::string> Enter(const std::string& name, std::string_view token, absl::Duration time_to_live,
                                    absl::Time now);
  // Returns true if control was granted; otherwise notes that the bearer asks for it. The owner always gets it, and the
  // policy becomes CONTROL_POLICY_OWNER; others get it if no one holds it and the policy is not CONTROL_POLICY_OWNER.
  absl::StatusOr<bool> Take(std::string_view token, absl::Time now);
  // Gives control to the person of that name; FAILED_PRECONDITION if no one has entered under it. The bearer must own
  // the session or control it alone.
  absl::Status Hand(std::string_view token, const std::string& name, absl::Time now);
  // Sets CONTROL_POLICY_EVERYBODY. PERMISSION_DENIED for a holder if the policy is CONTROL_POLICY_OWNER.
  absl::Status HandToEverybody(std::string_view token, absl::Time now);
  // Gives up control, or stops asking for it; control is then as the policy says. FAILED_PRECONDITION for the owner.
  absl::Status Release(std::string_view token, absl::Time now);

  // Adds a link, and removes expired ones. RESOURCE_EXHAUSTED past kMostLinks.
  absl::Status AddLink(ControlState::Link link, absl::Time now);
  // NOT_FOUND if there is no such link.
  absl::Status RemoveLink(const std::string& id);

  // Removes the people whose time is over. Returns true if there were any. The owner is never removed, but counts as
  // away. If the holder has expired, control is as the policy says.
  bool Expire(absl::Time now);
  // Returns when the next person expires; the infinite future if none will.
  absl::Time next_expiry() const;

 private:
  using Person = ControlState::Person;

  // Compares in constant time, as Find does.
  bool IsOwner(std::string_view token) const;
  // Returns the owner or person with this token; null if no one has it. Valid until people enter or expire.
  Person* Find(std::string_view token);
  // Returns the person of `people` who controls; null if none does.
  const Person* Holder() const;
  // Gives control to this token's bearer; empty: as the policy says. Counts a revision in any case.
  void GiveTo(std::string holder);
  // Returns the person who has entered with this token and renews their time, or PERMISSION_DENIED.
  absl::StatusOr<Person*> Known(std::string_view token, absl::Time now);
  // The same for a person who controls alone or owns the session.
  absl::StatusOr<Person*> KnownToDecide(std::string_view token, absl::Time now);
  // ALREADY_EXISTS if a person other than `self`, or the owner, has this name.
  absl::Status CheckFree(const std::string& name, const Person* self, absl::Time now) const;
  // Returns PERMISSION_DENIED, which says who controls, until when, and what to do.
  absl::Status Refuse(absl::Time now) const;

  ControlState state_;
};

// Returns INVALID_ARGUMENT unless the name has 1 to 40 characters, no control characters, and no space at its ends.
absl::Status CheckName(const std::string& field, const std::string& name);

inline constexpr std::size_t kMostPeople = 256;
inline constexpr std::size_t kMostLinks = 64;

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_CONTROL_H_
