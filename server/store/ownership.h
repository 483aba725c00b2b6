// Several servers that share their sessions: which of them has which, and a second copy of what each saves, from which
// another one goes on. A server by itself has none of this.
#ifndef PHRENIC_SERVER_STORE_OWNERSHIP_H_
#define PHRENIC_SERVER_STORE_OWNERSHIP_H_

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "phrenic/v1/saved.pb.h"
#include "server/mechanics/state.h"
#include "server/store/layout.h"

namespace phrenic::store {

// What a store has just written of one session.
struct Written {
  std::string id;
  bool forgotten = false;
  std::optional<v1::SavedScene> scene;  // of a new session
  std::int64_t sequence = 0;            // of `state`
  v1::SavedMoment moment;               // at `state`
  std::shared_ptr<const State> state;   // null: none
  std::vector<std::pair<std::int64_t, v1::SavedMoment>> moments;
};

// Any thread may call, but for Copy and CopyWhole.
class Ownership {
 public:
  virtual ~Ownership() = default;

  // Of a session that nobody has: its epoch. ALREADY_EXISTS where another server has it, UNAVAILABLE where it cannot be
  // known now.
  virtual absl::StatusOr<std::int64_t> Claim(const std::string& id) = 0;
  // Of one that this server's own store has: its next epoch. FAILED_PRECONDITION where another server has had it since,
  // or it was deleted; UNAVAILABLE as above.
  virtual absl::StatusOr<std::int64_t> Reclaim(const SavedSession& saved) = 0;
  // Of one that could not be made after all.
  virtual void Abandon(const std::string& id) = 0;
  // Of one that has ended here and is saved: another server may go on with it at once. Waits, for a bounded time, until
  // its copy is whole.
  virtual void Release(const std::string& id) = 0;

  // Whether this server still had the session when the copy was made; where it did not, nothing was copied. A copy that
  // cannot be made now is asked for again (Store::CopyWhole). The store's thread calls, and waits for a bounded time.
  virtual bool Copy(const Written& written) = 0;
  // All that the store has of it.
  virtual void CopyWhole(const SavedSession& saved) = 0;
};

}  // namespace phrenic::store

#endif  // PHRENIC_SERVER_STORE_OWNERSHIP_H_
