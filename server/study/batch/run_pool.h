// Numbered runs on several threads, their results in the order in which they end.
#ifndef PHRENIC_SERVER_STUDY_BATCH_RUN_POOL_H_
#define PHRENIC_SERVER_STUDY_BATCH_RUN_POOL_H_

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <deque>
#include <functional>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "absl/cleanup/cleanup.h"
#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "absl/synchronization/mutex.h"
#include "absl/time/clock.h"
#include "absl/time/time.h"
#include "server/study/context.h"

namespace phrenic::study {

// Returns how many threads do `runs` runs: `wanted`, or one per core if it is 0, and no more than cores or runs.
inline int ThreadsFor(int wanted, std::size_t runs) {
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  return static_cast<int>(std::min({wanted > 0 ? static_cast<std::size_t>(wanted) : cores, cores, runs}));
}

inline constexpr absl::Duration kLookEvery = absl::Milliseconds(100);

// Makes the result of run number `run`. CANCELLED, or any result, once `ended`, asked every few steps, returns true.
template <typename Result>
using MakeResult = std::function<absl::StatusOr<Result>(std::size_t run, const std::function<bool()>& ended)>;

// Results on their way from the threads of the runs to the caller's. Thread-safe.
template <typename Result>
class ResultQueue {
 public:
  ResultQueue(std::size_t runs, std::size_t capacity, const MakeResult<Result>& make)
      : runs_(runs), capacity_(capacity), make_(make) {}

  // Makes results until none is left or the queue has ended.
  void Work() {
    const std::function<bool()> ended = [this] { return ended_.load(); };
    for (std::size_t run = next_++; run < runs_ && !ended_; run = next_++) {
      if (!Put(make_(run, ended))) return;
    }
  }

  // Returns the next result; waits for it for a moment, and returns nothing if none came.
  std::optional<Result> Take() {
    const absl::MutexLock lock(&mutex_);
    mutex_.AwaitWithTimeout(absl::Condition(this, &ResultQueue::HasNews), kLookEvery);
    if (results_.empty()) return std::nullopt;
    Result result = std::move(results_.front());
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
  bool HasRoom() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) { return ended_ || results_.size() < capacity_; }

  // Keeps a result, once there is room for it. Returns false if the queue has ended.
  bool Put(absl::StatusOr<Result> result) {
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

  const std::size_t runs_, capacity_;
  const MakeResult<Result>& make_;
  std::atomic<std::size_t> next_ = 0;
  std::atomic<bool> ended_ = false;
  absl::Mutex mutex_;
  std::deque<Result> results_ ABSL_GUARDED_BY(mutex_);
  absl::Status status_ ABSL_GUARDED_BY(mutex_);
};

// Calls `make` for every number below `runs` on `threads` threads, and `take` on the calling thread with each result as
// it ends. While `take` falls behind, runs wait: no more results than two a thread are in memory. CANCELLED if `take`
// returns false, or `cancelled`, called on the calling thread several times a second, returns true; otherwise the first
// error of `make`, which ends the other runs. An exception of `take` or `cancelled`, or of a thread that cannot be made
// (std::system_error), ends the runs and reaches the caller.
template <typename Result>
absl::Status RunOnThreads(std::size_t runs, int threads, const MakeResult<Result>& make,
                          absl::FunctionRef<bool(Result)> take, absl::FunctionRef<bool()> cancelled) {
  ResultQueue<Result> queue(runs, static_cast<std::size_t>(threads), make);
  bool taken = true;
  {
    std::vector<std::jthread> workers;
    workers.reserve(static_cast<std::size_t>(threads));
    const absl::Cleanup end = [&queue] { queue.End(); };  // before the threads are joined, on exceptions too
    for (int i = 0; i < threads; ++i) workers.emplace_back([&queue] { queue.Work(); });
    absl::Time look = absl::Now() + kLookEvery;
    for (std::size_t done = 0; done < runs && taken && queue.status().ok();) {
      if (std::optional<Result> result = queue.Take()) {
        taken = take(*std::move(result));
        ++done;
      }
      if (!taken || absl::Now() < look) continue;
      taken = !cancelled();
      look = absl::Now() + kLookEvery;
    }
  }
  if (!taken) return Cancelled();
  return queue.status();
}

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_BATCH_RUN_POOL_H_
