// Which server of a cluster owns which session, and a second copy of what each server saves, from which another server
// continues. A single server has no Ownership.
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
  std::shared_ptr<const State> state;   // null: unchanged
  std::vector<std::pair<std::int64_t, v1::SavedMoment>> moments;
};

// What became of a copy.
enum class Copied {
  kYes,
  kLater,  // not now; Store::CopyWhole will be called
  kLost,   // another server has the session
};

// Any thread may call the methods, except Copy and CopyWhole, which the store's thread calls.
class Ownership {
 public:
  virtual ~Ownership() = default;

  // Claims a session that no server owns, and returns its epoch. ALREADY_EXISTS if another server owns it, UNAVAILABLE
  // if that cannot be found out now.
  virtual absl::StatusOr<std::int64_t> Claim(const std::string& id) = 0;
  // Claims a session of this server's own store again, and returns its next epoch. FAILED_PRECONDITION if another
  // server has owned it since, or if it was deleted; UNAVAILABLE as above.
  virtual absl::StatusOr<std::int64_t> Reclaim(const SavedSession& saved) = 0;
  // Gives up the claim of a session that could not be created.
  virtual void Abandon(const std::string& id) = 0;
  // Releases a session that has ended here and is saved, so that another server can continue it at once. Waits, for a
  // bounded time, until its copy is complete.
  virtual void Release(const std::string& id) = 0;

  // Returns OK if no other server can have the session now. UNAVAILABLE says why this server cannot know, and that it
  // must not acknowledge a change. Does not wait.
  virtual absl::Status CheckLease(const std::string& id) const = 0;
  // Deletes the session for all servers, before its server deletes it. UNAVAILABLE if that is not certain; then the
  // session goes on, or ends as one that is lost. ABORTED if another server has it.
  virtual absl::Status Delete(const std::string& id) = 0;

  // Copies what was written; kLost copies nothing. Waits for a bounded time.
  virtual Copied Copy(const Written& written) = 0;
  // Copies everything that the store has of a session. Returns kLater if that failed.
  virtual Copied CopyWhole(const SavedSession& saved) = 0;
};

}  // namespace phrenic::store

#endif  // PHRENIC_SERVER_STORE_OWNERSHIP_H_
