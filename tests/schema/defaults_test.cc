#include <gtest/gtest.h>

#include "phrenic/v1/session.pb.h"
#include "server/schema/schema.h"

namespace phrenic::schema {
namespace {

TEST(Defaults, ComeFromTheSchema) {
  v1::Parameters parameters;
  FillDefaults(&parameters);
  EXPECT_EQ(parameters.breath_force(), 1);
  EXPECT_EQ(parameters.breath_length(), 4);
  EXPECT_TRUE(parameters.has_apply_muscles());
  EXPECT_TRUE(parameters.apply_muscles());
}

TEST(Defaults, LeaveAutomaticQuantitiesUnset) {
  v1::Parameters parameters;
  FillDefaults(&parameters);
  EXPECT_FALSE(parameters.has_time_step());
}

TEST(Defaults, NeverReplaceWhatIsSet) {
  v1::Parameters parameters;
  parameters.set_breath_force(0);
  parameters.set_apply_muscles(false);
  FillDefaults(&parameters);
  EXPECT_EQ(parameters.breath_force(), 0);
  EXPECT_FALSE(parameters.apply_muscles());
}

TEST(Defaults, ReachNestedMessagesThatAreSet) {
  v1::Scene scene;
  scene.add_forces()->mutable_springs();
  scene.add_forces()->mutable_friction()->set_rate(7);
  scene.mutable_parameters();
  FillDefaults(&scene);
  EXPECT_EQ(scene.forces(0).springs().stiffness(), 100);
  EXPECT_EQ(scene.forces(1).friction().rate(), 7);
  EXPECT_EQ(scene.parameters().breath_length(), 4);
}

TEST(Defaults, CreateNoMessages) {
  v1::Scene scene;
  scene.add_bodies();
  FillDefaults(&scene);
  EXPECT_FALSE(scene.has_parameters());
  EXPECT_FALSE(scene.has_breath());
  EXPECT_EQ(scene.bodies(0).shape_case(), v1::Body::SHAPE_NOT_SET);
}

TEST(Defaults, LeaveNumbersWithoutPresenceUnchanged) {
  v1::StepSessionRequest request;
  FillDefaults(&request);
  EXPECT_EQ(request.ticks(), 0);
}

TEST(Defaults, AreIdempotent) {
  v1::Scene once;
  once.add_forces()->mutable_attachment();
  FillDefaults(&once);
  v1::Scene twice = once;
  FillDefaults(&twice);
  EXPECT_EQ(once.SerializeAsString(), twice.SerializeAsString());
}

}  // namespace
}  // namespace phrenic::schema
