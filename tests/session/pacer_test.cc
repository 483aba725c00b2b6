#include "server/session/pacer.h"

#include <gtest/gtest.h>

#include "server/session/pace_meter.h"

namespace phrenic::session {
namespace {

const absl::Time kStart = absl::FromUnixSeconds(1'700'000'000);

TEST(Pacer, TargetIsSpeedTimesElapsed) {
  Pacer pacer;
  pacer.Start(kStart, 3, 2);
  EXPECT_NEAR(pacer.Target(kStart + absl::Milliseconds(50), 3), 3.1, 1e-12);
}

TEST(Pacer, LostTimeBeyondATenthOfASecondIsNotMadeUp) {
  Pacer pacer;
  pacer.Start(kStart, 0, 2);
  EXPECT_NEAR(pacer.Target(kStart + absl::Seconds(5), 0), 0.2, 1e-12);
  EXPECT_NEAR(pacer.Target(kStart + absl::Milliseconds(5050), 0.2), 0.3, 1e-9) << "the clock starts anew from there";
}

TEST(Pacer, AClockThatIsSetBackStopsNothing) {
  Pacer pacer;
  pacer.Start(kStart, 0, 1);
  EXPECT_GE(pacer.Target(kStart - absl::Hours(1), 1), 1);
  EXPECT_NEAR(pacer.Target(kStart - absl::Hours(1) + absl::Milliseconds(50), 1), 1.05, 1e-9);
}

TEST(Pacer, FramesAreDueEverySixtiethAndNeverInABurst) {
  Pacer pacer;
  pacer.Start(kStart, 0, 1);
  EXPECT_FALSE(pacer.FrameDue(kStart + absl::Milliseconds(16)));
  EXPECT_TRUE(pacer.FrameDue(kStart + absl::Milliseconds(17)));
  pacer.FrameMade(kStart + absl::Seconds(1));
  EXPECT_GE(pacer.next_frame(), kStart + absl::Seconds(1)) << "late frames are made up for";
}

TEST(PaceMeter, MeasuresStepsAndSimulatedTimePerSecond) {
  PaceMeter meter;
  meter.Start(kStart, 100, 1.0);
  EXPECT_FALSE(meter.Update(kStart + absl::Milliseconds(900), 1000, 1.9));
  ASSERT_TRUE(meter.Update(kStart + absl::Seconds(2), 4100, 5.0));
  EXPECT_NEAR(meter.pace().steps_per_second(), 2000, 1e-6);
  EXPECT_NEAR(meter.pace().times_real_time(), 2, 1e-9);
}

}  // namespace
}  // namespace phrenic::session
