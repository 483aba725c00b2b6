// A session's status, as every thread reads it.
#ifndef PHRENIC_SERVER_SESSION_STATUS_BOARD_H_
#define PHRENIC_SERVER_SESSION_STATUS_BOARD_H_

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/functional/function_ref.h"
#include "absl/synchronization/mutex.h"
#include "phrenic/v1/session.pb.h"
#include "server/session/control.h"

namespace phrenic::session {

// Who may see a session, on a server with accounts.
struct SessionAccess {
  std::string account;  // the owner; empty: every account may see it
  std::vector<ControlState::Link> links;
};

// The stepping thread writes the status between two steps; any thread reads a copy. Thread-safe. mutex_ is held while a
// status is copied, and never while the session steps.
class StatusBoard {
 public:
  explicit StatusBoard(v1::Session first) : status_(std::move(first)) {}

  // The number of viewers and `not_saved` are not in it (SessionReporter::status).
  v1::Session Read() const ABSL_LOCKS_EXCLUDED(mutex_) {
    absl::MutexLock lock(&mutex_);
    return status_;
  }
  // Null before the first report; the object never changes.
  std::shared_ptr<const SessionAccess> access() const ABSL_LOCKS_EXCLUDED(mutex_) {
    absl::MutexLock lock(&mutex_);
    return access_;
  }
  // Changes the status, and the access if `access` is not null. `change` runs under the lock.
  void Write(absl::FunctionRef<void(v1::Session& status)> change, std::shared_ptr<const SessionAccess> access = nullptr)
      ABSL_LOCKS_EXCLUDED(mutex_) {
    absl::MutexLock lock(&mutex_);
    change(status_);
    if (access != nullptr) access_ = std::move(access);
  }

 private:
  mutable absl::Mutex mutex_;
  v1::Session status_ ABSL_GUARDED_BY(mutex_);
  std::shared_ptr<const SessionAccess> access_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_STATUS_BOARD_H_
