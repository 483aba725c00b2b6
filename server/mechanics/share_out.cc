#include "server/mechanics/share_out.h"

#include <algorithm>
#include <atomic>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <memory>
#include <thread>
#include <vector>

namespace phrenic {
namespace {

// Fewer parts take less time than it takes to wake a thread.
constexpr std::int64_t kLeastParts = 16;
// How often a thread looks whether the others are done before it lets somebody else have its core.
constexpr int kSpins = 2000;

// How often a helper looks for work before it sleeps: longer than from one part of a step to the next, as waking it
// takes longer than it would help.
constexpr int kLooks = 1000;

// Threads that help whoever posts work.
class Pool {
 public:
  explicit Pool(int threads) {
    for (int i = 0; i < threads; ++i) threads_.emplace_back([this] { Help(); });
  }
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;
  ~Pool() {
    guard_.reset();
    for (std::thread& thread : threads_) thread.join();
  }

  template <typename Work>
  void Post(Work work) {
    boost::asio::post(context_, std::move(work));
  }

 private:
  void Help() {
    for (int looks = 0; !context_.stopped(); ++looks) {
      if (context_.poll_one() > 0 || (looks > kLooks && context_.run_one() > 0)) looks = 0;
    }
  }

  boost::asio::io_context context_;
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> guard_{context_.get_executor()};
  std::vector<std::thread> threads_;
};

struct Helpers {
  int threads = 1;  // with the caller
  std::unique_ptr<Pool> pool;
};

Helpers& TheHelpers() {
  static Helpers helpers;
  return helpers;
}

// One call's parts, taken one by one by whoever is free. A helper that comes when all are taken does not touch `work`,
// which is gone when the caller is.
class Parts {
 public:
  Parts(std::int64_t count, absl::FunctionRef<void(std::int64_t)> work) : count_(count), work_(work) {}

  void Take() {
    for (std::int64_t part = next_++; part < count_; part = next_++) {
      work_(part);
      ++done_;
    }
  }
  void Await() const {
    for (int spins = 0; done_ < count_; ++spins) {
      if (spins > kSpins) std::this_thread::yield();
    }
  }

 private:
  const std::int64_t count_;
  const absl::FunctionRef<void(std::int64_t)> work_;
  std::atomic<std::int64_t> next_ = 0, done_ = 0;
};

}  // namespace

void SetStepThreads(int threads) {
  Helpers& helpers = TheHelpers();
  helpers.pool.reset();
  helpers.threads = std::max(1, threads);
  if (helpers.threads > 1) helpers.pool = std::make_unique<Pool>(threads - 1);
}

int StepThreads() { return TheHelpers().threads; }

void ShareOut(std::int64_t parts, absl::FunctionRef<void(std::int64_t)> work) {
  const Helpers& helpers = TheHelpers();
  if (helpers.threads == 1 || parts < kLeastParts) {
    for (std::int64_t part = 0; part < parts; ++part) work(part);
    return;
  }
  const auto shared = std::make_shared<Parts>(parts, work);
  for (int i = 1; i < helpers.threads; ++i) helpers.pool->Post([shared] { shared->Take(); });
  shared->Take();
  shared->Await();
}

}  // namespace phrenic
