#include "server/study/batch/run_all.h"

#include <atomic>
#include <deque>
#include <optional>
#include <thread>
#include <utility>

#include "absl/synchronization/mutex.h"
#include "server/jobs/thread_priority.h"

namespace phrenic::study {
namespace {

constexpr absl::Duration kLookEvery = absl::Milliseconds(100);  // at `cancelled`

// Results on their way from the threads of the runs to the caller's. Thread-safe.
class ResultQueue {
 public:
  ResultQueue(const Batch& batch, const std::function<bool()>& cancelled) : batch_(batch), cancelled_(cancelled) {}

  // Takes runs until none is left or the batch has ended.
  void Work() {
    jobs::LowerThreadPriority();
    const std::function<bool()> stop = [this] { return ended_ || cancelled_(); };
    for (std::size_t next = next_++; next < batch_.wanted().size() && !ended_; next = next_++) {
      absl::StatusOr<v1::BatchResult> result = batch_.Run(batch_.wanted()[next], stop);
      if (!Put(std::move(result))) return;
    }
  }

  // Returns the next result; waits for it at most kLookEvery, and returns nothing if none came.
  std::optional<v1::BatchResult> Take() {
    const absl::MutexLock lock(&mutex_);
    mutex_.AwaitWithTimeout(absl::Condition(this, &ResultQueue::HasNews), kLookEvery);
    if (results_.empty()) return std::nullopt;
    v1::BatchResult result = std::move(results_.front());
    results_.pop_front();
    return result;
  }

  void End() {
    ended_ = true;
    const absl::MutexLock lock(&mutex_);  // wakes those who wait in Put
  }

  absl::Status status() {
    const absl::MutexLock lock(&mutex_);
    return status_;
  }

 private:
  bool HasNews() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) { return !results_.empty() || !status_.ok(); }
  bool HasRoom() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) {
    return ended_ || results_.size() < static_cast<size_t>(batch_.threads());
  }

  // Keeps a result, once there is room for it. Returns false if the batch has ended.
  bool Put(absl::StatusOr<v1::BatchResult> result) {
    const absl::MutexLock lock(&mutex_);
    if (!result.ok()) {
      status_.Update(result.status());
      ended_ = true;
      return false;
    }
    mutex_.Await(absl::Condition(this, &ResultQueue::HasRoom));
    if (ended_) return false;
    results_.push_back(*std::move(result));
    return true;
  }

  const Batch& batch_;
  const std::function<bool()>& cancelled_;
  std::atomic<std::size_t> next_ = 0;  // in batch_.wanted()
  std::atomic<bool> ended_ = false;
  absl::Mutex mutex_;
  std::deque<v1::BatchResult> results_ ABSL_GUARDED_BY(mutex_);
  absl::Status status_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace

absl::Status RunAll(const Batch& batch, absl::FunctionRef<bool(v1::BatchResult)> take,
                    const std::function<bool()>& cancelled) {
  ResultQueue queue(batch, cancelled);
  bool taken = true;
  {
    std::vector<std::jthread> workers;
    workers.reserve(static_cast<size_t>(batch.threads()));
    for (int i = 0; i < batch.threads(); ++i) workers.emplace_back([&queue] { queue.Work(); });
    for (std::size_t done = 0; done < batch.wanted().size() && taken && queue.status().ok();) {
      if (std::optional<v1::BatchResult> result = queue.Take()) {
        taken = take(*std::move(result));
        ++done;
      } else {
        taken = !cancelled();
      }
    }
    queue.End();
  }
  if (!taken) return Cancelled();
  return queue.status();
}

}  // namespace phrenic::study
