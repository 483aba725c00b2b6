// Threads that run tasks, started when they are needed.
#ifndef PHRENIC_SERVER_SERVICE_CALLS_WORKER_THREADS_H_
#define PHRENIC_SERVER_SERVICE_CALLS_WORKER_THREADS_H_

#include <deque>
#include <functional>
#include <thread>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"

namespace phrenic::service {

// Runs up to `most` tasks at a time, in the order in which they were posted. Thread-safe.
class WorkerThreads {
 public:
  explicit WorkerThreads(std::size_t most) : most_(most) {}
  // Runs all posted tasks, and waits for them.
  ~WorkerThreads();
  WorkerThreads(const WorkerThreads&) = delete;
  WorkerThreads& operator=(const WorkerThreads&) = delete;

  void Post(std::function<void()> task) ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  void Run() ABSL_LOCKS_EXCLUDED(mutex_);

  const std::size_t most_;
  absl::Mutex mutex_;
  std::deque<std::function<void()>> tasks_ ABSL_GUARDED_BY(mutex_);
  std::size_t idle_ ABSL_GUARDED_BY(mutex_) = 0;  // threads that wait for a task
  bool ended_ ABSL_GUARDED_BY(mutex_) = false;
  std::vector<std::thread> threads_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_CALLS_WORKER_THREADS_H_
