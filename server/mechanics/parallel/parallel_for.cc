#include "server/mechanics/parallel/parallel_for.h"

#include <hwy/cache_control.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <memory>
#include <thread>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"

namespace phrenic {
namespace {

// Fewer parts take less time than waking a thread.
constexpr std::int64_t kLeastParts = 16;
// Polls for the end of the other threads before the caller yields its core.
constexpr int kSpins = 2000;
// Time for which a helper polls for work before it sleeps: longer than from one loop of a step to the next, since
// waking it takes longer than its help saves.
constexpr std::chrono::microseconds kPollTime(50);

// The parts of one call, in one run per thread. A thread begins with its own run and goes on with the rest of the
// others. A helper that comes after all parts are taken does not call `work`, which is gone once the caller has
// returned.
class Parts {
 public:
  Parts(std::int64_t count, int threads, absl::FunctionRef<void(std::int64_t)> work)
      : count_(count), runs_(std::min<std::int64_t>(threads, kMostRuns)), work_(work) {
    for (std::int64_t r = 0; r < runs_; ++r) run_[r].next = count * r / runs_, run_[r].end = count * (r + 1) / runs_;
  }

  void Take(int thread) {
    for (std::int64_t i = 0; i < runs_; ++i) TakeRun(run_[(thread + i) % runs_]);
  }
  void Await() const {
    for (int spins = 0; done_ < count_; ++spins) {
      if (spins > kSpins) std::this_thread::yield();
    }
  }

 private:
  static constexpr std::int64_t kMostRuns = 16;
  struct alignas(64) Run {
    std::atomic<std::int64_t> next = 0;
    std::int64_t end = 0;
  };

  void TakeRun(Run& run) {
    std::int64_t taken = 0;
    for (std::int64_t part = run.next++; part < run.end; part = run.next++, ++taken) work_(part);
    if (taken > 0) done_ += taken;
  }

  const std::int64_t count_, runs_;
  const absl::FunctionRef<void(std::int64_t)> work_;
  std::array<Run, kMostRuns> run_;
  std::atomic<std::int64_t> done_ = 0;
};

// Threads that help the callers of ParallelFor.
class Helpers {
 public:
  explicit Helpers(int threads) {
    for (int i = 1; i <= threads; ++i) threads_.emplace_back([this, i] { Help(i); });
  }
  Helpers(const Helpers&) = delete;
  Helpers& operator=(const Helpers&) = delete;
  ~Helpers() {
    {
      absl::MutexLock lock(&mutex_);
      leaving_ = true;
    }
    for (std::thread& thread : threads_) thread.join();
  }

  int count() const { return static_cast<int>(threads_.size()); }

  // Asks every helper to take parts.
  void Invite(const std::shared_ptr<Parts>& parts) ABSL_LOCKS_EXCLUDED(mutex_) {
    absl::MutexLock lock(&mutex_);
    invitations_.insert(invitations_.end(), threads_.size(), parts);
    open_ = invitations_.size();
  }
  // Withdraws what no helper has accepted.
  void Withdraw(const std::shared_ptr<Parts>& parts) ABSL_LOCKS_EXCLUDED(mutex_) {
    if (open_ == 0) return;
    absl::MutexLock lock(&mutex_);
    std::erase(invitations_, parts);
    open_ = invitations_.size();
  }

 private:
  void Help(int own) {
    while (const std::shared_ptr<Parts> parts = Next()) parts->Take(own);
  }

  // Waits for the oldest invitation, polling first. Returns null if the helpers are to end.
  std::shared_ptr<Parts> Next() ABSL_LOCKS_EXCLUDED(mutex_) {
    const auto sleep = std::chrono::steady_clock::now() + kPollTime;
    while (open_ == 0 && std::chrono::steady_clock::now() < sleep) hwy::Pause();
    absl::MutexLock lock(&mutex_);
    mutex_.Await(absl::Condition(this, &Helpers::HasNews));
    if (leaving_) return nullptr;
    std::shared_ptr<Parts> parts = std::move(invitations_.front());
    invitations_.erase(invitations_.begin());
    open_ = invitations_.size();
    return parts;
  }
  bool HasNews() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) { return leaving_ || !invitations_.empty(); }

  absl::Mutex mutex_;
  std::vector<std::shared_ptr<Parts>> invitations_ ABSL_GUARDED_BY(mutex_);  // oldest first, one per helper and call
  bool leaving_ ABSL_GUARDED_BY(mutex_) = false;
  std::atomic<std::size_t> open_ = 0;  // invitations, for polls without the lock
  std::vector<std::thread> threads_;
};

std::unique_ptr<Helpers>& TheHelpers() {
  static std::unique_ptr<Helpers> helpers;  // null: the caller works alone
  return helpers;
}

}  // namespace

void SetStepThreads(int threads) {
  TheHelpers().reset();
  if (threads > 1) TheHelpers() = std::make_unique<Helpers>(threads - 1);
}

int StepThreads() { return TheHelpers() == nullptr ? 1 : TheHelpers()->count() + 1; }

void ParallelFor(std::int64_t parts, absl::FunctionRef<void(std::int64_t)> work) {
  Helpers* const helpers = TheHelpers().get();
  if (helpers == nullptr || parts < kLeastParts) {
    for (std::int64_t part = 0; part < parts; ++part) work(part);
    return;
  }
  const auto shared = std::make_shared<Parts>(parts, helpers->count() + 1, work);
  helpers->Invite(shared);
  shared->Take(0);
  helpers->Withdraw(shared);
  shared->Await();
}

}  // namespace phrenic
