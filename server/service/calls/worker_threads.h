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
//
// CallLimits has one for all lanes. A thread starts when a task finds no idle one, and stays until the destructor. The
// queue has no limit of its own: the places of the lanes limit it (FairShare). A task must not throw.
class WorkerThreads {
 public:
  // Starts no thread.
  explicit WorkerThreads(std::size_t most) : most_(most) {}
  // Runs all posted tasks, and waits for them. Requires: none but running tasks post any more.
  ~WorkerThreads();
  WorkerThreads(const WorkerThreads&) = delete;
  WorkerThreads& operator=(const WorkerThreads&) = delete;

  // Returns at once. The task, with what it captures, is destroyed on its thread before that takes the next one. May be
  // called by a task.
  void Post(std::function<void()> task) ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  // The loop of one thread.
  void Run() ABSL_LOCKS_EXCLUDED(mutex_);

  const std::size_t most_;  // threads
  absl::Mutex mutex_;
  std::deque<std::function<void()>> tasks_ ABSL_GUARDED_BY(mutex_);  // not started, oldest first
  std::size_t idle_ ABSL_GUARDED_BY(mutex_) = 0;                     // threads that wait for a task
  bool ended_ ABSL_GUARDED_BY(mutex_) = false;                       // the destructor has begun
  std::vector<std::thread> threads_ ABSL_GUARDED_BY(mutex_);         // moved out by the destructor
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_CALLS_WORKER_THREADS_H_
