// The bodies of client/examples/bodies.txt breathe a quiet breath.
#include "tests/anatomy/ten_bodies.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "server/anatomy/anatomy.h"
#include "server/mechanics/compile/compile.h"
#include "server/mechanics/compile/presets.h"
#include "server/physiology/rows.h"
#include "server/schema/body_size.h"
#include "server/schema/physique.h"
#include "tests/physiology/generated_thorax.h"

namespace phrenic {
namespace {

v1::Scene BodyScene(const v1::Physique& physique) {
  std::ifstream file(PHRENIC_SOURCE_DIR "/server/scenes/thorax.textproto");
  std::stringstream text;
  text << file.rdbuf();
  v1::Scene scene = *schema::ParseScene("thorax.textproto", text.str());
  EXPECT_TRUE(schema::ReplacePhysique(physique, &scene).ok());
  return scene;
}

std::shared_ptr<const Model> CompileBody(const v1::Scene& scene) {
  return *Compile(scene, [](const v1::Body& body) {
    v1::Generated shape = body.generated();
    shape.set_resolution_mm(8);  // half the time of their own
    return anatomy::Generate(body.anatomy(), shape);
  });
}

double TidalVolume(const physiology::Recording& breath) {
  const auto& volume = breath.of[physiology::kVolume];
  const auto [least, greatest] = std::minmax_element(volume.begin(), volume.end());
  return *greatest - *least;
}

struct BodyBreath {
  std::shared_ptr<const Model> model;
  std::unique_ptr<const physiology::Subject> subject;
  physiology::Recording recording;
  double abdominal_share = 0;  // [%]
};

std::unique_ptr<BodyBreath> Breathe(const v1::Scene& scene) {
  auto breath = std::make_unique<BodyBreath>();
  breath->model = CompileBody(scene);
  breath->subject = *physiology::Subject::Of(*breath->model);
  breath->recording = *QuietBreath(*breath->subject);
  EXPECT_EQ(breath->recording.problem, "");
  breath->abdominal_share = physiology::AbdominalShare(breath->recording, breath->recording);
  return breath;
}

// A body by its place in the list, and the range of its right dome's descent [mm]: that of health, and with a barrel
// chest 40 to 80 % of health's 14.3 mm, as in COPD.
struct BreathingBody {
  size_t place;
  double least = 10, most = 25;
};

class TenBodiesBreathe : public testing::TestWithParam<BreathingBody> {};

// The adult's 0.4 to 0.7 l, of the total lung capacity; the abdominal share of people of all sizes.
TEST_P(TenBodiesBreathe, AQuietBreathOfTheirSizeWithoutFlaws) {
  const NamedBody body = TenBodies()[GetParam().place];
  SCOPED_TRACE(body.title);
  const auto breath = Breathe(BodyScene(body.physique));
  const physiology::Recording& recording = breath->recording;
  const double right = DomeDescent(*breath->subject, recording.peak, v1::SIDE_RIGHT),
               lungs = schema::SizeOf(body.physique).lungs, tidal = TidalVolume(recording);
  std::printf("%s: tidal volume %.2f l, of a lung of %.2f; right dome %.1f mm; abdomen %.0f %%\n", body.title.c_str(),
              1e3 * tidal, lungs, right, breath->abdominal_share);
  EXPECT_GT(tidal, 0.4e-3 * lungs);
  EXPECT_LT(tidal, 0.7e-3 * lungs);
  EXPECT_GT(breath->abdominal_share, 52);
  EXPECT_LT(breath->abdominal_share, 75);
  EXPECT_GT(right, GetParam().least);
  EXPECT_LT(right, GetParam().most);
  for (const physiology::Flaw flaw :
       {physiology::kSelfCrossings, physiology::kCrossedLayers, physiology::kPiercingRibs}) {
    EXPECT_EQ(recording.flaws[flaw], 0) << "flaw " << flaw;
  }
}

INSTANTIATE_TEST_SUITE_P(Bodies, TenBodiesBreathe,
                         testing::Values(BreathingBody{3}, BreathingBody{4}, BreathingBody{6, 5.7, 11.4},
                                         BreathingBody{9}));

// The cause: with the adult's tissues and lungs the same muscles of a small body leave too much to the abdomen.
TEST(ForcesOfASmallBody, OfTheAdultGiveTheAbdomenTooMuch) {
  v1::Scene scene = BodyScene(TenBodies()[3].physique);
  scene.clear_physique();  // the bodies' own stay
  EXPECT_GT(Breathe(scene)->abdominal_share, 75);
}

// The adult's ranges are those of the table; of a small body volumes are smaller, and shares are everybody's.
TEST(RangesOfBodies, FollowTheLungsInLitresAloneAndAreTheTablesInTheAdult) {
  const v1::Physique adult = TenBodies()[0].physique, small = TenBodies()[3].physique;
  for (const auto rows : {physiology::RowsOfHealth(), physiology::RowsOfChanges()}) {
    for (const physiology::Row& row : rows) {
      EXPECT_EQ(physiology::RangeFor(row, adult).low, row.low) << row.what;
      EXPECT_EQ(physiology::RangeFor(row, adult).high, row.high) << row.what;
      const double of_small = physiology::RangeFor(row, small).high, high = row.high;
      const std::string unit = row.unit;
      if (unit == "l") {
        EXPECT_LT(std::abs(of_small), 0.7 * std::abs(high)) << row.what;
      } else if (unit != "mm") {
        EXPECT_EQ(of_small, high) << row.what;
      }
    }
  }
}

}  // namespace
}  // namespace phrenic
