// Calls that other threads make to a session's stepping thread.
#ifndef PHRENIC_SERVER_SESSION_COMMAND_QUEUE_H_
#define PHRENIC_SERVER_SESSION_COMMAND_QUEUE_H_

#include <atomic>
#include <deque>
#include <functional>
#include <memory>
#include <optional>

#include "absl/base/thread_annotations.h"
#include "absl/functional/function_ref.h"
#include "absl/status/status.h"
#include "absl/synchronization/mutex.h"
#include "absl/synchronization/notification.h"
#include "server/schema/clock.h"

namespace phrenic::session {

// Any thread calls Call, Close and called; only the stepping thread calls Await and Finish. SteppingLoop owns it.
// mutex_ is not held while a command runs.
class CommandQueue {
 public:
  // `act` refers to the stack of its caller, which waits for `done`.
  struct Command {
    std::function<void()> act;
    std::shared_ptr<absl::Notification> done;
  };
  struct Batch {
    std::deque<Command> commands;  // in the order of the calls
    bool closed = false;           // then none of them runs
  };

  // `clock` outlives the queue.
  explicit CommandQueue(const Clock& clock) : clock_(clock) {}

  // Has the stepping thread run `act` between two steps, and waits for it. Returns the reason of Close if `act` did not
  // run. The queue holds as many commands as there are callers waiting. Never call it from `act` or from the stepping
  // thread: it would wait for itself.
  absl::Status Call(absl::FunctionRef<void()> act) ABSL_LOCKS_EXCLUDED(mutex_);
  // Refuses waiting and later calls with `reason`. Returns false if the queue was closed before. Does not wait; the
  // first reason counts.
  bool Close(const absl::Status& reason) ABSL_LOCKS_EXCLUDED(mutex_);
  // True if a call or Close waits for the stepping thread. A hint, which ends a burst of steps early. Read without the
  // mutex.
  bool called() const { return called_; }

  // Waits for a call, Close or `deadline`, and takes all commands. Returns at once if a command waits, if the queue is
  // closed, or if `deadline` is past; the batch may be empty.
  Batch Await(absl::Time deadline) ABSL_LOCKS_EXCLUDED(mutex_);
  // Runs the commands, unless the queue is closed, and wakes their callers.
  static void Finish(const Batch& batch);

 private:
  // True if Await need not wait.
  bool Pending() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) { return !commands_.empty() || closed_.has_value(); }

  const Clock& clock_;
  absl::Mutex mutex_;
  std::deque<Command> commands_ ABSL_GUARDED_BY(mutex_);
  std::optional<absl::Status> closed_ ABSL_GUARDED_BY(mutex_);
  std::atomic<bool> called_ = false;
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_COMMAND_QUEUE_H_
