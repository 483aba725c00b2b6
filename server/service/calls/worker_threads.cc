#include "server/service/calls/worker_threads.h"

#include <utility>

namespace phrenic::service {

WorkerThreads::~WorkerThreads() {
  std::vector<std::thread> threads;
  {
    absl::MutexLock lock(&mutex_);
    ended_ = true;
    threads.swap(threads_);
  }
  for (std::thread& thread : threads) thread.join();
}

void WorkerThreads::Post(std::function<void()> task) {
  absl::MutexLock lock(&mutex_);
  tasks_.push_back(std::move(task));
  if (idle_ < tasks_.size() && threads_.size() < most_) threads_.emplace_back([this] { Run(); });
}

// A thread counts as idle before it destroys its task, which may post the next one.
void WorkerThreads::Run() {
  const auto wake = [this] {
    mutex_.AssertHeld();
    return ended_ || !tasks_.empty();
  };
  std::function<void()> task;
  for (;;) {
    {
      absl::MutexLock lock(&mutex_);
      ++idle_;
    }
    task = nullptr;
    {
      absl::MutexLock lock(&mutex_);
      mutex_.Await(absl::Condition(&wake));
      --idle_;
      if (tasks_.empty()) return;
      task = std::move(tasks_.front());
      tasks_.pop_front();
    }
    task();
  }
}

}  // namespace phrenic::service
