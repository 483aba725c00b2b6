// ThreadSanitizer reports no race between accesses ordered by Abseil's mutexes, and still reports unordered ones.
#include <gtest/gtest.h>

#include <thread>

#include "absl/synchronization/mutex.h"
#include "absl/synchronization/notification.h"

namespace {

TEST(AbslMutex, OrdersWhatItGuards) {
  absl::Mutex mutex;
  int count = 0;
  const auto add = [&] {
    for (int i = 0; i < 1000; ++i) {
      absl::MutexLock lock(&mutex);
      ++count;
    }
  };
  std::thread other(add);
  add();
  other.join();
  EXPECT_EQ(count, 2000);
}

TEST(AbslMutex, AwaitOrdersWhatItWaitsFor) {
  absl::Mutex mutex;
  int turn = 0;
  const auto play = [&](int mine) {
    for (int round = 0; round < 200; ++round) {
      const int wanted = 2 * round + mine;
      const auto my_turn = [&turn, &wanted] { return turn == wanted; };
      absl::MutexLock lock(&mutex);
      ASSERT_TRUE(mutex.AwaitWithTimeout(absl::Condition(&my_turn), absl::Seconds(60)));
      ++turn;
    }
  };
  std::thread other(play, 1);
  play(0);
  other.join();
  EXPECT_EQ(turn, 400);
}

TEST(AbslNotification, OrdersWhatCameBeforeIt) {
  absl::Notification done;
  int value = 0;
  std::thread other([&] {
    value = 7;
    done.Notify();
  });
  done.WaitForNotification();
  EXPECT_EQ(value, 7);
  value = 8;
  other.join();
}

TEST(ThreadSanitizer, StillSeesARace) {
  testing::GTEST_FLAG(death_test_style) = "threadsafe";
  EXPECT_DEATH(
      {
        absl::Mutex mutex;
        int count = 0;
        const auto add = [&] {
          for (int i = 0; i < 100000; ++i) ++count;
          absl::MutexLock lock(&mutex);
        };
        std::thread other(add);
        add();
        other.join();
        _exit(count == 0 ? 1 : 0);
      },
      "data race");
}

}  // namespace
