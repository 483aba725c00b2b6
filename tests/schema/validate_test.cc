#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "phrenic/v1/export.pb.h"
#include "phrenic/v1/session.pb.h"
#include "server/schema/schema.h"

namespace phrenic::schema {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

// A valid scene.
v1::Scene ValidScene() {
  v1::Scene scene;
  scene.set_name("sound");
  v1::Body& body = *scene.add_bodies();
  body.set_name("sheet");
  body.set_role(v1::ROLE_DEFORMABLE);
  body.mutable_grid()->set_columns(2);
  body.mutable_grid()->set_rows(2);
  body.mutable_grid()->mutable_u()->set_x(1);
  body.mutable_grid()->mutable_v()->set_y(1);
  v1::Springs& springs = *scene.add_forces()->mutable_springs();
  springs.add_bodies("sheet");
  springs.set_stiffness(5);
  return scene;
}

std::string Refusal(const google::protobuf::Message& message) {
  const absl::Status status = Validate(message);
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  return std::string(status.message());
}

TEST(Validation, AcceptsAValidScene) { EXPECT_EQ(Validate(ValidScene()), absl::OkStatus()); }

TEST(Validation, NamesPathValueRangeAndUnit) {
  v1::Scene scene = ValidScene();
  scene.mutable_forces(0)->mutable_springs()->set_stiffness(-5);
  EXPECT_EQ(Refusal(scene), "forces[0].springs.stiffness: -5 is outside 0 to 1e+09 N/m");
}

TEST(Validation, IncludesTheEndsOfARange) {
  v1::Scene scene = ValidScene();
  for (const double end : {0.0, 1e9}) {
    scene.mutable_forces(0)->mutable_springs()->set_stiffness(end);
    EXPECT_EQ(Validate(scene), absl::OkStatus());
  }
  scene.mutable_forces(0)->mutable_springs()->set_stiffness(std::nextafter(1e9, 1e10));
  EXPECT_THAT(Refusal(scene), HasSubstr("1000000000.0000001 is outside"));
}

TEST(Validation, LeavesOutTheUnitOfAPureNumber) {
  v1::Parameters parameters;
  parameters.set_breath_force(21);
  EXPECT_EQ(Refusal(parameters), "breath_force: 21 is outside 0 to 20");
}

TEST(Validation, RefusesNumbersThatAreNotFiniteEverywhere) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                           -std::numeric_limits<double>::infinity()}) {
    v1::Scene scene = ValidScene();
    scene.mutable_forces(0)->mutable_springs()->set_stiffness(bad);
    EXPECT_THAT(Refusal(scene), HasSubstr("is not a finite number; allowed is 0 to 1e+09 N/m"));
    v1::Scene vector = ValidScene();  // a number without a Quantity
    vector.mutable_bodies(0)->mutable_grid()->mutable_origin()->set_z(bad);
    EXPECT_THAT(Refusal(vector), StartsWith("bodies[0].grid.origin.z: "));
  }
}

TEST(Validation, IntegersHaveRangesToo) {
  v1::Scene scene = ValidScene();
  scene.mutable_bodies(0)->mutable_grid()->set_rows(2001);
  EXPECT_EQ(Refusal(scene), "bodies[0].grid.rows: 2001 is outside 2 to 2000");
  v1::StepSessionRequest step;
  step.set_session_id("a");
  step.set_ticks(1000001);
  EXPECT_EQ(Refusal(step), "ticks: 1000001 is outside 1 to 1e+06");
}

TEST(Validation, UnsetNumbersWithoutPresenceAreZero) {
  v1::StepSessionRequest step;
  step.set_session_id("a");
  EXPECT_EQ(Refusal(step), "ticks: 0 is outside 1 to 1e+06");
}

TEST(Validation, UnsetOptionalNumbersAreValid) {
  v1::Scene scene = ValidScene();
  scene.mutable_forces(0)->mutable_springs()->clear_stiffness();
  scene.mutable_parameters();  // time_step may not be 0, and is not set
  EXPECT_EQ(Validate(scene), absl::OkStatus());
}

TEST(Validation, RequiredTextMustNotBeEmpty) {
  v1::Scene scene = ValidScene();
  scene.clear_name();
  EXPECT_EQ(Refusal(scene), "name: must be set: every Scene needs it");
  v1::GetSessionRequest request;
  EXPECT_THAT(Refusal(request), StartsWith("session_id: must be set"));
}

TEST(Validation, RequiredListsMustNotBeEmpty) {
  v1::Scene scene = ValidScene();
  scene.clear_bodies();
  EXPECT_EQ(Refusal(scene), "bodies: must not be empty: every Scene needs at least one");
}

TEST(Validation, RequiredMessagesMustBeSet) {
  v1::Scene scene = ValidScene();
  scene.mutable_bodies(0)->mutable_grid()->clear_v();
  EXPECT_EQ(Refusal(scene), "bodies[0].grid.v: must be set: every Grid needs it");
}

TEST(Validation, RequiredEnumsNameTheirValues) {
  v1::Scene scene = ValidScene();
  scene.mutable_bodies(0)->clear_role();
  EXPECT_EQ(Refusal(scene),
            "bodies[0].role: must be set: every Body needs one of ROLE_DEFORMABLE, ROLE_DRIVEN, ROLE_AT_REST, "
            "ROLE_SEEN");
}

TEST(Validation, RefusesUnknownEnumValues) {
  v1::Scene scene = ValidScene();
  scene.mutable_breath()->set_waveform(static_cast<v1::Waveform>(77));
  EXPECT_EQ(Refusal(scene), "breath.waveform: 77 is not one of WAVEFORM_SINE, WAVEFORM_RAISED_COSINE, WAVEFORM_TRACE");
}

TEST(Validation, NamesTheIndexInAList) {
  v1::Scene scene = ValidScene();
  for (int i = 0; i < 3; ++i) *scene.add_forces() = scene.forces(0);
  scene.mutable_forces(2)->mutable_springs()->set_rest_length_ratio(2.5);
  EXPECT_EQ(Refusal(scene), "forces[2].springs.rest_length_ratio: 2.5 is outside 0 to 2");
}

TEST(Validation, RefusesTextThatIsNotUtf8) {
  v1::Scene scene = ValidScene();
  scene.set_title("Zwerchfell, Diaphragme, \xe6\xa8\xaa\xe9\x9a\x94\xe8\x86\x9c");
  EXPECT_EQ(Validate(scene), absl::OkStatus());
  for (const char* bad : {"\xff", "cut \xe6\xa8", "\xc0\xaf", "\xed\xa0\x80"}) {
    scene.set_title(bad);
    EXPECT_THAT(Refusal(scene), StartsWith("title: the text is not UTF-8"));
  }
}

TEST(Validation, ChecksEveryValueOfARepeatedField) {
  v1::CreateExportRequest request;
  request.set_session_id("a");
  request.set_format("msh");
  request.add_bodies("lung");
  request.add_bodies("\xff");
  EXPECT_THAT(Refusal(request), StartsWith("bodies[1]: "));
}

}  // namespace
}  // namespace phrenic::schema
