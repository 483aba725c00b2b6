// Bodies of client/examples/bodies.txt breathe a quiet breath.
#include "tests/anatomy/ten_bodies.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "server/anatomy/anatomy.h"
#include "server/mechanics/compile/compile.h"
#include "server/mechanics/compile/presets.h"
#include "server/schema/physique.h"
#include "tests/physiology/generated_thorax.h"

namespace phrenic {
namespace {

std::shared_ptr<const Model> CompileBody(const v1::Physique& physique) {
  std::ifstream file(PHRENIC_SOURCE_DIR "/server/scenes/thorax.textproto");
  std::stringstream text;
  text << file.rdbuf();
  v1::Scene scene = *schema::ParseScene("thorax.textproto", text.str());
  EXPECT_TRUE(schema::ReplacePhysique(physique, &scene).ok());
  return *Compile(scene, [](const v1::Body& body) {
    v1::Generated shape = body.generated();
    shape.set_resolution_mm(8);  // half the time of their own
    return anatomy::Generate(body.anatomy(), shape);
  });
}

// A body, and the range of its right dome's descent [mm]: that of health, and with COPD 40 to 80 % of health's 14.3 mm.
struct BreathingBody {
  const char* title;
  double least, most;
};

class TenBodiesBreathe : public testing::TestWithParam<BreathingBody> {};

TEST_P(TenBodiesBreathe, AQuietBreathWithoutFlaws) {
  const std::vector<NamedBody> bodies = TenBodies();
  const auto body = std::ranges::find_if(bodies, [](const NamedBody& each) { return each.title == GetParam().title; });
  ASSERT_TRUE(body != bodies.end()) << GetParam().title;
  const auto model = CompileBody(body->physique);
  const auto subject = physiology::Subject::Of(*model);
  ASSERT_TRUE(subject.ok()) << subject.status();
  const auto breath = QuietBreath(**subject);
  ASSERT_TRUE(breath.ok()) << breath.status();
  EXPECT_EQ(breath->problem, "");
  const auto& volume = breath->of[physiology::kVolume];
  const auto [least, greatest] = std::minmax_element(volume.begin(), volume.end());
  const double right = DomeDescent(**subject, breath->peak, v1::SIDE_RIGHT),
               left = DomeDescent(**subject, breath->peak, v1::SIDE_LEFT), tidal = *greatest - *least;
  std::printf("%s: tidal volume %.2f l; descent %.1f and %.1f mm; %g crossings, %g layers, %g ribs\n", GetParam().title,
              1e3 * tidal, right, left, breath->flaws[physiology::kSelfCrossings],
              breath->flaws[physiology::kCrossedLayers], breath->flaws[physiology::kPiercingRibs]);
  EXPECT_GT(tidal, 0.4e-3);
  EXPECT_LT(tidal, 0.7e-3);
  EXPECT_GT(right, GetParam().least);
  EXPECT_LT(right, GetParam().most);
  EXPECT_EQ(breath->flaws[physiology::kSelfCrossings], 0);
  EXPECT_EQ(breath->flaws[physiology::kCrossedLayers], 0);
  EXPECT_EQ(breath->flaws[physiology::kPiercingRibs], 0);
}

INSTANTIATE_TEST_SUITE_P(Bodies, TenBodiesBreathe,
                         testing::Values(BreathingBody{"Woman, 30 years, 1.62 m", 10, 25},
                                         BreathingBody{"Barrel chest", 5.7, 11.4},
                                         BreathingBody{"Kyphosis, 65 degrees", 10, 25}));

}  // namespace
}  // namespace phrenic
