// Numbers of a body from text, in scenes, and what age does to tissue.
#include "server/schema/physique.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/schema/schema.h"

namespace phrenic::schema {
namespace {

using ::testing::HasSubstr;

v1::Scene SceneWith(const std::string& more) {
  const auto scene =
      ParseScene("x.textproto", "name: \"x\" bodies { name: \"a\" role: ROLE_SEEN generated {} } " + more);
  EXPECT_TRUE(scene.ok()) << scene.status();
  return scene.ok() ? *scene : v1::Scene();
}

TEST(PhysiqueText, SetsNumbersAndNamesTheFieldOfAnError) {
  v1::Physique physique;
  EXPECT_TRUE(SetPhysique("sex", "female", &physique).ok());
  EXPECT_TRUE(SetPhysique("age", " 70", &physique).ok());
  EXPECT_EQ(physique.sex(), v1::SEX_FEMALE);
  EXPECT_EQ(physique.age(), 70);
  EXPECT_THAT(SetPhysique("age", "7", &physique).message(), HasSubstr("age: 7 is outside 20 to 90 years"));
  EXPECT_THAT(SetPhysique("sex", "femal", &physique).message(), HasSubstr("female"));
  EXPECT_THAT(SetPhysique("hight", "1.7", &physique).message(), HasSubstr("height"));
  EXPECT_THAT(SetPhysique("height", "tall", &physique).message(), HasSubstr("height: \"tall\" is not a number"));
}

TEST(PhysiqueText, ReplacesTheScenesNumbersOneByOne) {
  v1::Scene scene = SceneWith("physique { height: 1.6 scoliosis_degrees: 20 }");
  v1::Physique other;
  other.set_height(1.9);
  ASSERT_TRUE(ReplacePhysique(other, &scene).ok());
  for (const v1::Physique& each : {scene.physique(), scene.bodies(0).generated().physique()}) {
    EXPECT_EQ(each.height(), 1.9);
    EXPECT_EQ(each.scoliosis_degrees(), 20);
  }
}

TEST(PhysiqueText, ThatCannotBeUsedIsAnError) {
  v1::Physique tall;
  tall.set_height(3);
  v1::Scene scene = SceneWith("");
  EXPECT_THAT(ReplacePhysique(tall, &scene).message(), HasSubstr("physique.height: 3 is outside"));
  v1::Scene empty;
  empty.set_name("cube");
  EXPECT_THAT(ReplacePhysique(v1::Physique(), &empty).message(), HasSubstr("\"cube\" generates no body"));
}

TEST(AgeOfAScene, StiffensCageAndAbdomenAsMeasuredUnlessTheSceneSaysOtherwise) {
  v1::Scene young = SceneWith("physique { age: 30 }"), old = SceneWith("physique { age: 65 }"),
            own = SceneWith("physique { age: 65 } parameters { chest_wall_compliance: 0.9 }"), none = SceneWith("");
  for (v1::Scene* scene : {&young, &old, &own, &none}) SetCompliancesOfAge(scene);
  EXPECT_EQ(young.parameters().chest_wall_compliance(), 1);
  EXPECT_NEAR(old.parameters().chest_wall_compliance(), 0.114 / 0.164, 0.02) << "Estenne et al. 1985";
  EXPECT_NEAR(old.parameters().abdominal_compliance(), 0.020 / 0.032, 0.02);
  EXPECT_EQ(own.parameters().chest_wall_compliance(), 0.9);
  EXPECT_FALSE(none.has_parameters());
  double before = 2;
  for (int age = 24; age <= 75; age += 3) {
    v1::Scene scene = SceneWith("physique { age: " + std::to_string(age) + " }");
    SetCompliancesOfAge(&scene);
    EXPECT_LT(scene.parameters().chest_wall_compliance(), before) << age;
    before = scene.parameters().chest_wall_compliance();
  }
}

}  // namespace
}  // namespace phrenic::schema
