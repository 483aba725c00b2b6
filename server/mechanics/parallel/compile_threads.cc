#include "server/mechanics/parallel/compile_threads.h"

#include <algorithm>
#include <atomic>
#include <system_error>
#include <thread>
#include <vector>

namespace phrenic {
namespace {

constexpr int kMostThreads = 16;

std::atomic<int>& Most() {
  static std::atomic<int> most = std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, kMostThreads);
  return most;
}

std::atomic<void (*)()>& FirstCall() {
  static std::atomic<void (*)()> start(+[] {});
  return start;
}

}  // namespace

void SetCompileThreadStart(void (*start)()) { FirstCall() = start; }

void SetCompileThreads(int threads) { Most() = std::clamp(threads, 1, kMostThreads); }

int CompileThreads() { return Most(); }

void ForEachPart(std::int64_t parts, absl::FunctionRef<void(std::int64_t)> work) {
  ForEachPartUntil(
      parts, [] { return false; }, work);
}

void ForEachPartUntil(std::int64_t parts, absl::FunctionRef<bool()> stopped,
                      absl::FunctionRef<void(std::int64_t)> work) {
  std::atomic<std::int64_t> next = 0;
  const auto take = [&](bool is_caller) {
    for (std::int64_t part = next++; part < parts; part = next++) {
      if (is_caller && stopped()) {
        next = parts;
        break;
      }
      work(part);
    }
  };
  std::vector<std::thread> others;
  const std::int64_t threads = std::min<std::int64_t>(CompileThreads(), parts);
  for (std::int64_t i = 1; i < threads; ++i) {
    try {
      others.emplace_back([&take] {
        FirstCall().load()();
        take(false);
      });
    } catch (const std::system_error&) {  // the system has no more threads: those that run do the work
      break;
    }
  }
  take(true);
  for (std::thread& other : others) other.join();
}

}  // namespace phrenic
