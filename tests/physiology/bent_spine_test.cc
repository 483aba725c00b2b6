// A thorax with a bent spine breathes as the thorax of health does: its shape is no obstacle to the mechanics.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "tests/physiology/generated_thorax.h"

namespace phrenic {
namespace {

TEST(BentSpine, BreathesAQuietBreathWithoutFlaws) {
  const auto model = CompileShipped("thorax-scoliosis");
  const auto subject = physiology::Subject::Of(*model);
  ASSERT_TRUE(subject.ok()) << subject.status();
  const auto breath = QuietBreath(**subject);
  ASSERT_TRUE(breath.ok()) << breath.status();
  EXPECT_EQ(breath->problem, "");
  const auto& volume = breath->of[physiology::kVolume];
  const auto [least, greatest] = std::minmax_element(volume.begin(), volume.end());
  std::printf("a bent spine: tidal volume %.2f l; descent %.1f and %.1f mm; %g crossings, %g layers, %g ribs\n",
              1e3 * (*greatest - *least), DomeDescent(**subject, breath->peak, v1::SIDE_RIGHT),
              DomeDescent(**subject, breath->peak, v1::SIDE_LEFT), breath->flaws[physiology::kSelfCrossings],
              breath->flaws[physiology::kCrossedLayers], breath->flaws[physiology::kPiercingRibs]);
  EXPECT_GT(*greatest - *least, 0.4e-3);
  EXPECT_LT(*greatest - *least, 0.7e-3);
  EXPECT_GT(DomeDescent(**subject, breath->peak, v1::SIDE_RIGHT), 5);
  EXPECT_GT(DomeDescent(**subject, breath->peak, v1::SIDE_LEFT), 5);
  EXPECT_EQ(breath->flaws[physiology::kSelfCrossings], 0);
  EXPECT_EQ(breath->flaws[physiology::kCrossedLayers], 0);
  EXPECT_EQ(breath->flaws[physiology::kPiercingRibs], 0);
}

}  // namespace
}  // namespace phrenic
