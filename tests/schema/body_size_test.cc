// A body's size, and the forces that follow it.
#include "server/schema/body_size.h"

#include <gtest/gtest.h>

#include "server/schema/schema.h"

namespace phrenic::schema {
namespace {

v1::Physique BodyOf(const std::string& text) {
  v1::Physique physique;
  EXPECT_TRUE(ParseText("physique", text, &physique).ok()) << text;
  return physique;
}

v1::Scene BreathingScene(const std::string& physique) {
  const auto scene = ParseScene("x.textproto", R"(
    name: "x" bodies { name: "a" role: ROLE_SEEN generated {} }
    forces { muscle { body: "a" from_region: "rim" tendon_region: "tendon" passive_regions: "hiatus" } }
    forces { thorax_pressures { body: "a" wall: "w" lungs { recoil_rate: 6.5e-4 } } }
    forces { chest_wall { wall: "w" segment_compliance: 8e-7 } })" +
                                                   physique);
  EXPECT_TRUE(scene.ok()) << scene.status();
  return *scene;
}

TEST(BodySize, OfTheAdultIsExactlyOne) {
  for (const char* text : {"", "sex: SEX_MALE age: 30 height: 1.75", "scoliosis_degrees: 40 left_dome_height: 0.01"}) {
    const BodySize size = SizeOf(BodyOf(text));
    for (const double ratio : {size.length, size.volume, size.lungs, size.resting, size.inspired, size.vital}) {
      EXPECT_EQ(ratio, 1) << text;
    }
  }
}

// The published formulas, worked out by hand: men of 1.75 m and 30 years have 6.9025, 3.275 and 1.7225 l.
TEST(BodySize, HasThePublishedVolumes) {
  const BodySize woman = SizeOf(BodyOf("sex: SEX_FEMALE height: 1.6 age: 50"));
  EXPECT_NEAR(woman.lungs, 4.77 / 6.9025, 1e-12);
  EXPECT_NEAR(woman.resting, 2.634 / 3.275, 1e-12);
  EXPECT_NEAR(woman.inspired, 2.136 / 3.6275, 1e-12);
  EXPECT_NEAR(woman.vital, 3.074 / 5.18, 1e-12);
  EXPECT_NEAR(SizeOf(BodyOf("height: 1.85 age: 50")).resting, (4.329 + 0.45 - 1.09) / 3.275, 1e-12);
}

TEST(BodySize, GrowsWithHeightAndChestWithoutJumps) {
  for (const char* sex : {"sex: SEX_MALE", "sex: SEX_FEMALE"}) {
    BodySize before = {0, 0, 0, 0, 0, 0};
    for (double height = 1.2; height < 2.2; height += 0.01) {
      v1::Physique physique = BodyOf(sex);
      physique.set_height(height);
      const BodySize size = SizeOf(physique);
      EXPECT_GT(size.volume, before.volume);
      EXPECT_GT(size.resting, before.resting);
      EXPECT_GT(size.inspired, before.inspired);
      if (before.inspired > 0) {
        EXPECT_LT(size.inspired - before.inspired, 0.03) << height;
      }
      before = size;
    }
  }
  EXPECT_NEAR(SizeOf(BodyOf("chest_width: 1.1")).inspired, 1.1, 1e-12);
  EXPECT_EQ(SizeOf(BodyOf("age: 90")).vital, SizeOf(BodyOf("age: 70")).vital);
}

TEST(ForcesOfABody, FollowItsSize) {
  v1::Scene scene = BreathingScene("physique { height: 1.5 sex: SEX_FEMALE }"), adult = BreathingScene("");
  const BodySize size = SizeOf(scene.physique());
  ScaleForcesToPhysique(&scene);
  FillDefaults(&adult);
  const auto& lungs = scene.forces(1).thorax_pressures().lungs();
  const auto& of = adult.forces(1).thorax_pressures().lungs();
  EXPECT_EQ(lungs.room(), size.inspired * of.room());
  EXPECT_EQ(lungs.rest_volume(), size.resting * of.rest_volume());
  EXPECT_DOUBLE_EQ(lungs.resistance() * lungs.rest_volume(), of.resistance() * of.rest_volume())
      << "specific resistance";
  EXPECT_EQ(lungs.recoil_rate(), 6.5e-4);
  EXPECT_EQ(scene.forces(2).chest_wall().compliance(), size.volume * adult.forces(2).chest_wall().compliance());
  EXPECT_EQ(scene.forces(0).muscle().thickness(), size.length * adult.forces(0).muscle().thickness());
  EXPECT_EQ(scene.forces(0).muscle().active_stress(), adult.forces(0).muscle().active_stress());
  EXPECT_EQ(scene.forces(0).muscle().passive_regions_size(), 1);
}

TEST(ForcesOfABody, KeepTheirNumbersAndAreScaledOnce) {
  v1::Scene own = BreathingScene("physique { height: 1.5 }");
  own.mutable_forces(2)->mutable_chest_wall()->set_compliance(2e-6);
  ScaleForcesToPhysique(&own);
  EXPECT_EQ(own.forces(2).chest_wall().compliance(), 2e-6);
  EXPECT_EQ(own.forces(2).chest_wall().segment_compliance(), 8e-7);
  v1::Scene again = own;
  ScaleForcesToPhysique(&again);
  EXPECT_EQ(again.SerializeAsString(), own.SerializeAsString());
}

TEST(ForcesOfABody, AreUntouchedInTheAdult) {
  for (const char* physique : {"", "physique { scoliosis_degrees: 40 kyphosis_degrees: 20 }", "physique { age: 30 }"}) {
    v1::Scene scene = BreathingScene(physique);
    const std::string before = scene.SerializeAsString();
    ScaleForcesToPhysique(&scene);
    EXPECT_EQ(scene.SerializeAsString(), before) << physique;
  }
}

}  // namespace
}  // namespace phrenic::schema
