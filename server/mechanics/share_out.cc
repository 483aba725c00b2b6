#include "server/mechanics/share_out.h"

#include <algorithm>
#include <atomic>
#include <boost/asio/post.hpp>
#include <boost/asio/thread_pool.hpp>
#include <memory>
#include <thread>

namespace phrenic {
namespace {

// Fewer parts take less time than it takes to wake a thread.
constexpr std::int64_t kLeastParts = 16;
// How often a thread looks whether the others are done before it lets somebody else have its core.
constexpr int kSpins = 2000;

struct Helpers {
  int threads = 1;  // with the caller
  std::unique_ptr<boost::asio::thread_pool> pool;
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
  if (helpers.pool != nullptr) helpers.pool->join();
  helpers.threads = std::max(1, threads);
  helpers.pool =
      helpers.threads > 1 ? std::make_unique<boost::asio::thread_pool>(static_cast<size_t>(threads - 1)) : nullptr;
}

int StepThreads() { return TheHelpers().threads; }

void ShareOut(std::int64_t parts, absl::FunctionRef<void(std::int64_t)> work) {
  const Helpers& helpers = TheHelpers();
  if (helpers.threads == 1 || parts < kLeastParts) {
    for (std::int64_t part = 0; part < parts; ++part) work(part);
    return;
  }
  const auto shared = std::make_shared<Parts>(parts, work);
  for (int i = 1; i < helpers.threads; ++i) boost::asio::post(*helpers.pool, [shared] { shared->Take(); });
  shared->Take();
  shared->Await();
}

}  // namespace phrenic
