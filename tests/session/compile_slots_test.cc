#include "server/session/compile_slots.h"

#include <gmock/gmock.h>

#include <atomic>
#include <thread>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"

namespace phrenic::session {
namespace {

using Lane = CompileSlots::Lane;

template <class Condition>
bool Eventually(const Condition& condition) {
  for (int i = 0; i < 2000 && !condition(); ++i) absl::SleepFor(absl::Milliseconds(10));
  return condition();
}

TEST(CompileSlots, OneGreedyAccountLeavesASlotForOthers) {
  CompileSlots slots(3, 2);
  std::vector<CompileSlots::Slot> held;
  for (int i = 0; i < 2; ++i) held.push_back(*slots.Take("greedy", Lane::kSmall, nullptr));
  std::atomic<bool> stop = false;
  std::vector<std::thread> waiting;
  for (int i = 0; i < 8; ++i) {
    waiting.emplace_back([&] { slots.Take("greedy", Lane::kSmall, [&] { return stop.load(); }).IgnoreError(); });
  }
  EXPECT_TRUE(slots.Take("modest", Lane::kSmall, nullptr).ok());
  EXPECT_TRUE(slots.Take("modest", Lane::kLarge, nullptr).ok()) << "lanes do not wait for each other";
  EXPECT_TRUE(Eventually([&] {
    return absl::IsResourceExhausted(slots.Take("greedy", Lane::kSmall, [] { return true; }).status());
  })) << "its line is bounded";
  EXPECT_TRUE(slots.Take("modest", Lane::kSmall, nullptr).ok());
  stop = true;
  for (std::thread& thread : waiting) thread.join();
  held.clear();
  EXPECT_TRUE(slots.Take("greedy", Lane::kSmall, nullptr).ok()) << "slots come back";
}

TEST(CompileSlots, TheAccountServedLeastRecentlyIsNext) {
  CompileSlots slots(1, 1);
  auto running = slots.Take("greedy", Lane::kLarge, nullptr);
  std::atomic<int> greedy_done = 0, waiting = 0;
  std::atomic<int> before_modest = -1;
  std::vector<std::thread> threads;
  for (int i = 0; i < 5; ++i) {
    threads.emplace_back([&] {
      const auto slot = slots.Take("greedy", Lane::kLarge, [&] {
        ++waiting;
        return false;
      });
      ++greedy_done;
    });
  }
  ASSERT_TRUE(Eventually([&] { return waiting >= 5; }));
  std::atomic<bool> modest_waits = false;
  threads.emplace_back([&] {
    const auto slot = slots.Take("modest", Lane::kLarge, [&] {
      modest_waits = true;
      return false;
    });
    before_modest = greedy_done.load();
  });
  ASSERT_TRUE(Eventually([&] { return modest_waits.load(); }));
  running = absl::CancelledError();
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(before_modest, 0) << "although five of the other waited before it";
}

TEST(CompileSlots, WhoLeavesGivesUpItsPlace) {
  CompileSlots slots(1, 1);
  const auto running = slots.Take("a", Lane::kSmall, nullptr);
  for (int i = 0; i < 20; ++i) {
    EXPECT_TRUE(absl::IsCancelled(slots.Take("b", Lane::kSmall, [] { return true; }).status()));
  }
}

}  // namespace
}  // namespace phrenic::session
