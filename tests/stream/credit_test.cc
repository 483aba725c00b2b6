// What a viewer is sent over lines of known width and delay, simulated to the millisecond.
#include "server/stream/credit.h"

#include <gtest/gtest.h>

#include <cmath>

namespace phrenic::stream {
namespace {

// A line that carries one frame after the other, and acknowledgements back at once.
struct Line {
  double bytes_per_second = 0;
  absl::Duration delay = absl::ZeroDuration();
};

// What came of watching 60 frames a second for a while.
struct Watched {
  double frames_per_second = 0;  // over the last five seconds
  absl::Duration oldest = absl::ZeroDuration();
  int coarsest = 0;
};

// A frame of 13 kB at 0.1 mm, and a quarter less for each rung above.
double FrameBytes(int bound_level) { return 13e3 * std::pow(0.75, bound_level - kDefaultBoundLevel); }

Watched Watch(Credit& credit, const Line& line, int seconds) {
  struct Frame {
    std::int64_t sequence;
    absl::Time made, arrives;
  };
  std::deque<Frame> underway;
  Watched watched;
  const absl::Time start = absl::UnixEpoch(), last = start + absl::Seconds(seconds);
  absl::Time free = start;  // when the line has carried everything
  std::int64_t sequence = 0, waiting = 0;
  int came = 0;
  for (absl::Time now = start; now < last; now += absl::Milliseconds(1)) {
    for (; !underway.empty() && underway.front().arrives <= now; underway.pop_front()) {
      credit.Acknowledged(underway.front().sequence, now);
      if (now < last - absl::Seconds(5)) continue;
      ++came;
      watched.oldest = std::max(watched.oldest, now - underway.front().made);
    }
    if (absl::ToInt64Milliseconds(now - start) % 17 == 0) {
      if (waiting > 0) credit.Missed(now);
      waiting = ++sequence;
    }
    if (waiting == 0 || !credit.MaySend()) continue;
    credit.Sent(waiting, now);
    free = std::max(free, now) + absl::Seconds(FrameBytes(credit.bound_level()) / line.bytes_per_second);
    underway.push_back({waiting, now, free + line.delay});
    waiting = 0;
    watched.coarsest = std::max(watched.coarsest, credit.bound_level());
  }
  watched.frames_per_second = came / 5.0;
  return watched;
}

Credit Browser() { return Credit({.window = 6, .bound_level = kDefaultBoundLevel, .may_coarsen = true}); }

TEST(Credit, AWideLineTakesEverythingAsItIs) {
  Credit credit = Browser();
  const Watched watched = Watch(credit, {.bytes_per_second = 100e6, .delay = absl::Milliseconds(2)}, 20);
  EXPECT_GT(watched.frames_per_second, 57);
  EXPECT_EQ(watched.coarsest, kDefaultBoundLevel);
}

TEST(Credit, ALongLineKeepsItsFrames) {
  Credit credit = Browser();
  const Watched watched = Watch(credit, {.bytes_per_second = 100e6, .delay = absl::Milliseconds(90)}, 20);
  EXPECT_GT(watched.frames_per_second, 50);
  EXPECT_EQ(watched.coarsest, kDefaultBoundLevel);
}

TEST(Credit, AThinLineGetsFewerFramesAndNoOldOnes) {
  Credit credit = Browser();
  const Watched watched = Watch(credit, {.bytes_per_second = 500e3, .delay = absl::Milliseconds(10)}, 30);
  EXPECT_GT(watched.frames_per_second, 30);
  EXPECT_LT(watched.oldest, absl::Milliseconds(300));
  EXPECT_EQ(watched.coarsest, kDefaultBoundLevel) << "frames are given up before precision";
}

TEST(Credit, AVeryThinLineGetsCoarserFramesToo) {
  Credit credit = Browser();
  const Watched watched = Watch(credit, {.bytes_per_second = 60e3, .delay = absl::Milliseconds(10)}, 40);
  EXPECT_GT(watched.coarsest, kDefaultBoundLevel);
  EXPECT_LE(watched.coarsest, kCoarsestBoundLevel);
  EXPECT_LT(watched.oldest, absl::Milliseconds(500));
  EXPECT_GT(watched.frames_per_second, 8);
}

TEST(Credit, ABoundThatWasAskedForStays) {
  Credit credit({.window = 6, .bound_level = kDefaultBoundLevel, .may_coarsen = false});
  EXPECT_EQ(Watch(credit, {.bytes_per_second = 60e3}, 40).coarsest, kDefaultBoundLevel);
}

TEST(Credit, ALineThatWidensGetsItsPrecisionBack) {
  Credit credit = Browser();
  Watch(credit, {.bytes_per_second = 60e3}, 40);
  ASSERT_GT(credit.bound_level(), kDefaultBoundLevel);
  Credit* const same = &credit;
  for (std::int64_t sequence = 1'000'000, i = 0; i < 600 * 60; ++i, ++sequence) {
    const absl::Time now = absl::UnixEpoch() + absl::Seconds(100) + i * absl::Milliseconds(17);
    same->Acknowledged(sequence - 1, now);
    same->Sent(sequence, now);
  }
  EXPECT_EQ(credit.bound_level(), kDefaultBoundLevel);
}

TEST(Credit, NothingGoesPastTheWindowUntilItIsAcknowledged) {
  Credit credit({.window = 3});
  for (std::int64_t sequence = 1; sequence <= 3; ++sequence) {
    EXPECT_TRUE(credit.MaySend());
    credit.Sent(sequence, absl::UnixEpoch());
  }
  EXPECT_FALSE(credit.MaySend());
  credit.Acknowledged(2, absl::UnixEpoch());
  EXPECT_TRUE(credit.MaySend());
  credit.Acknowledged(77, absl::UnixEpoch());
  credit.Acknowledged(1, absl::UnixEpoch());
}

TEST(FrameEncoding, RungsAreOneTwoAndFive) {
  EXPECT_EQ(BoundLevelWithin(0.1), kDefaultBoundLevel);
  EXPECT_EQ(BoundLevelWithin(1), kCoarsestBoundLevel);
  EXPECT_EQ(BoundLevelWithin(0.001), 0);
  EXPECT_DOUBLE_EQ(BoundMillimetres(BoundLevelWithin(0.3)), 0.2);
  EXPECT_DOUBLE_EQ(BoundMillimetres(BoundLevelWithin(10)), 10);
}

}  // namespace
}  // namespace phrenic::stream
