#include "server/mechanics/parallel/parallel_for.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <memory>
#include <thread>
#include <vector>

namespace phrenic {
namespace {

// Fewer parts take less time than waking a thread.
constexpr std::int64_t kLeastParts = 16;
// Polls for the end of the other threads before the caller yields its core.
constexpr int kSpins = 2000;

// Polls for work before a helper sleeps: longer than from one loop of a step to the next, since waking it takes longer
// than its help saves.
constexpr int kPolls = 1000;

// Threads that run posted work.
class Pool {
 public:
  explicit Pool(int threads) {
    for (int i = 1; i <= threads; ++i) threads_.emplace_back([this, i] { Help(i); });
  }
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;
  ~Pool() {
    guard_.reset();
    for (std::thread& thread : threads_) thread.join();
  }

  template <typename Work>
  void Post(Work work) {
    boost::asio::post(context_, [work = std::move(work)] { work(number); });
  }

 private:
  void Help(int own) {
    number = own;
    for (int polls = 0; !context_.stopped(); ++polls) {
      if (context_.poll_one() > 0 || (polls > kPolls && context_.run_one() > 0)) polls = 0;
    }
  }

  static thread_local int number;  // identity of a helper thread, from 1 on; 0 for other threads

  boost::asio::io_context context_;
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> guard_{context_.get_executor()};
  std::vector<std::thread> threads_;
};

thread_local int Pool::number = 0;

struct Helpers {
  int threads = 1;  // with the caller
  std::unique_ptr<Pool> pool;
};

Helpers& TheHelpers() {
  static Helpers helpers;
  return helpers;
}

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

}  // namespace

void SetStepThreads(int threads) {
  Helpers& helpers = TheHelpers();
  helpers.pool.reset();
  helpers.threads = std::max(1, threads);
  if (helpers.threads > 1) helpers.pool = std::make_unique<Pool>(threads - 1);
}

int StepThreads() { return TheHelpers().threads; }

void ParallelFor(std::int64_t parts, absl::FunctionRef<void(std::int64_t)> work) {
  const Helpers& helpers = TheHelpers();
  if (helpers.threads == 1 || parts < kLeastParts) {
    for (std::int64_t part = 0; part < parts; ++part) work(part);
    return;
  }
  const auto shared = std::make_shared<Parts>(parts, helpers.threads, work);
  for (int i = 1; i < helpers.threads; ++i) helpers.pool->Post([shared](int helper) { shared->Take(helper); });
  shared->Take(0);
  shared->Await();
}

}  // namespace phrenic
