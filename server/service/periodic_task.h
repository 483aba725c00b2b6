// Calls a function periodically.
#ifndef PHRENIC_SERVER_SERVICE_PERIODIC_TASK_H_
#define PHRENIC_SERVER_SERVICE_PERIODIC_TASK_H_

#include <functional>
#include <thread>
#include <utility>

#include "absl/synchronization/notification.h"
#include "absl/time/time.h"

namespace phrenic::service {

// Calls `work` on its own thread, first one `pause` after construction and then one `pause` after each call returns.
// The destructor waits for a call in progress.
//
// `work` must not throw and must not destroy the task. A slow call delays the next one, and calls never overlap. What
// `work` uses outlives the task; the server therefore ends its tasks first.
class PeriodicTask {
 public:
  // Starts the thread.
  PeriodicTask(absl::Duration pause, std::function<void()> work)
      : thread_([this, pause, work = std::move(work)] {
          while (!ended_.WaitForNotificationWithTimeout(pause)) work();
        }) {}
  // Takes as long as a call in progress; a pause ends at once.
  ~PeriodicTask() {
    ended_.Notify();
    thread_.join();
  }
  PeriodicTask(const PeriodicTask&) = delete;
  PeriodicTask& operator=(const PeriodicTask&) = delete;

 private:
  absl::Notification ended_;  // set by the destructor
  std::thread thread_;        // last: it uses the others
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_PERIODIC_TASK_H_
