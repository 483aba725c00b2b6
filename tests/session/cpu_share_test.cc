#include "server/session/cpu_share.h"

#include <gtest/gtest.h>

#include <random>

namespace phrenic::session {
namespace {

TEST(CpuShare, OverALongTimeTheThreadUsesNoMoreThanItsShare) {
  std::mt19937 random(1);
  std::exponential_distribution<double> work(50), pause(20);  // [1/s]
  for (const double share : {0.05, 0.3, 0.9}) {
    CpuShare limit(share);
    absl::Duration cpu;
    absl::Time now = absl::UnixEpoch();
    for (int i = 0; i < 2000; ++i) {
      now = std::max(now + absl::Seconds(pause(random)) * (i % 100 == 0), limit.RestsUntil(now));
      limit.Begin(now, cpu);
      const absl::Duration took = absl::Seconds(work(random));
      cpu += took, now += took;
      limit.End(cpu);
    }
    EXPECT_LE(absl::ToDoubleSeconds(cpu),
              share * absl::ToDoubleSeconds(limit.RestsUntil(now) - absl::UnixEpoch()) + 1e-6);
    EXPECT_GT(absl::ToDoubleSeconds(cpu), 0.8 * share * absl::ToDoubleSeconds(now - absl::UnixEpoch()));
  }
}

TEST(CpuShare, AClockThatIsSetBackDoesNotDelayWork) {
  CpuShare limit(0.01);
  limit.Begin(absl::UnixEpoch(), absl::ZeroDuration());
  limit.End(absl::Seconds(5));
  const absl::Time earlier = absl::UnixEpoch() - absl::Hours(1);
  EXPECT_LE(limit.RestsUntil(earlier), earlier);
  limit.Begin(earlier, absl::Seconds(5));
  limit.End(absl::Seconds(6));
  EXPECT_EQ(limit.RestsUntil(earlier), earlier + absl::Seconds(100));
}

TEST(CpuShare, AWholeCoreIsNoLimit) {
  CpuShare limit(1);
  limit.Begin(absl::UnixEpoch(), absl::ZeroDuration());
  limit.End(absl::Seconds(5));
  EXPECT_EQ(limit.RestsUntil(absl::UnixEpoch()), absl::InfinitePast());
}

}  // namespace
}  // namespace phrenic::session
