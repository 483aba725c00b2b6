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
class PeriodicTask {
 public:
  PeriodicTask(absl::Duration pause, std::function<void()> work)
      : thread_([this, pause, work = std::move(work)] {
          while (!ended_.WaitForNotificationWithTimeout(pause)) work();
        }) {}
  ~PeriodicTask() {
    ended_.Notify();
    thread_.join();
  }
  PeriodicTask(const PeriodicTask&) = delete;
  PeriodicTask& operator=(const PeriodicTask&) = delete;

 private:
  absl::Notification ended_;
  std::thread thread_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_PERIODIC_TASK_H_
