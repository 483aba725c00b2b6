// Lungs that boundary modes move, with ellipsoids in place of lungs.
#include "server/mechanics/motions/lung_modes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/mechanics/measure.h"
#include "server/mechanics/state_warnings.h"
#include "server/mesh/topology.h"
#include "tests/compile_text.h"

namespace phrenic {
namespace {

using testing::HasSubstr;

std::string Lung(const std::string& name, const std::string& side, double x) {
  return "bodies { name: '" + name +
         "' layer: 'lungs' role: ROLE_DEFORMABLE mass: 0.5 anatomy { structure: " + "STRUCTURE_LUNG side: SIDE_" +
         side + " } ellipsoid { centre { x: " + std::to_string(x) +
         " } radii { x: 0.05 y: 0.08 z: 0.12 } divisions: 10 } } ";
}

std::string Lungs(const std::string& parameters, const std::string& more = "") {
  return "name: 'lungs' breath { waveform: WAVEFORM_RAISED_COSINE } " + Lung("r", "RIGHT", -0.07) +
         Lung("l", "LEFT", 0.07) + "motions { lung_modes { lungs: 'lungs' " + more + "} } parameters { " + parameters +
         " time_step: 0.01 } ";
}

// The displacement at the peak of a breath of 4 s.
Points DisplacementIn(const std::string& scene) {
  const auto model = CompileText(scene);
  return RunTo(*model, 2, 0.01).x - model->rest;
}

TEST(LungModes, MoveNothingWithoutAnAmplitudeOrABreath) {
  EXPECT_TRUE(DisplacementIn(Lungs("")).isZero(0));
  EXPECT_TRUE(DisplacementIn(Lungs("lung_piston_right: 0.02 breath_force: 0")).isZero(0));
}

TEST(LungModes, AreLinearInAmplitudeAndForce) {
  const Points piston = DisplacementIn(Lungs("lung_piston_right: 0.02")),
               pump = DisplacementIn(Lungs("lung_pump: 0.01")),
               both = DisplacementIn(Lungs("lung_piston_right: 0.04 lung_pump: 0.03")),
               stronger = DisplacementIn(Lungs("lung_pump: 0.01 breath_force: 3"));
  EXPECT_GT(piston.norm(), 0.01);
  EXPECT_LT((both - 2 * piston - 3 * pump).norm(), 1e-12);
  EXPECT_LT((stronger - 3 * pump).norm(), 1e-12);
}

TEST(LungModes, OfOneSideMoveThatLungAlone) {
  const Points moved = DisplacementIn(Lungs("lung_piston_right: 0.02"));
  const Eigen::Index half = moved.cols() / 2;
  EXPECT_TRUE(moved.rightCols(half).isZero(0));
  double lowest = 0;
  for (Eigen::Index i = 0; i < half; ++i) lowest = std::min(lowest, moved(2, i));
  EXPECT_NEAR(lowest, -0.02, 0.004) << "the base follows the wall below it";
}

TEST(LungModes, OfBothLungsAreMirrorImages) {
  const auto model =
      CompileText(Lungs("lung_piston_right: 0.02 lung_piston_left: 0.02 lung_mediastinum: 0.01 lung_tilt_left_right: "
                        "0.01 lung_dome: 0.01"));
  const Points moved = RunTo(*model, 2, 0.01).x - model->rest;
  const Eigen::Index half = moved.cols() / 2;
  double worst = 0;
  for (Eigen::Index i = 0; i < half; ++i) {
    for (Eigen::Index j = half; j < 2 * half; ++j) {
      const Eigen::Vector3d mirrored = model->rest.col(j).cwiseProduct(Eigen::Vector3d(-1, 1, 1));
      if ((model->rest.col(i) - mirrored).norm() > 1e-9) continue;
      const Eigen::Vector3d motion = moved.col(j).cwiseProduct(Eigen::Vector3d(-1, 1, 1));
      worst = std::max(worst, (moved.col(i) - motion).norm());
    }
  }
  EXPECT_LT(worst, 1e-4) << "the bricks lie in the same way in both lungs";
}

TEST(LungModes, HaveTheVelocityOfTheirPositions) {
  const auto model = CompileText(Lungs("lung_piston_right: 0.02 lung_apex: 0.01"));
  const State before = RunTo(*model, 0.999, 0.001), at = RunTo(*model, 1, 0.001), after = RunTo(*model, 1.001, 0.001);
  EXPECT_LT(((after.x - before.x) / 0.002 - at.v).cwiseAbs().maxCoeff(), 1e-6 * at.v.cwiseAbs().maxCoeff() + 1e-7);
  EXPECT_GT(at.v.norm(), 0.01);
}

TEST(LungModes, WarnOfAVolumeThatNoLungHas) {
  const auto warnings = [](const std::string& parameters) {
    const auto model = CompileText(Lungs(parameters));
    return MotionWarnings(*model, RunTo(*model, 2, 0.01));
  };
  EXPECT_THAT(warnings("lung_piston_right: 0.02 lung_piston_left: 0.02 lung_pump: 0.01"), testing::IsEmpty());
  EXPECT_THAT(warnings("lung_piston_left: 0.04 breath_force: 20"),
              testing::ElementsAre(testing::AllOf(HasSubstr("l has "), HasSubstr("lower breath_force"))));
  EXPECT_THAT(warnings("lung_piston_left: -0.04 breath_force: 20"),
              testing::ElementsAre(testing::AllOf(HasSubstr("l has -"), HasSubstr("lung_*"))));
}

TEST(LungModes, CarryWhatLiesInside) {
  const std::string points =
      "bodies { name: 'points' role: ROLE_DEFORMABLE mass: 1 polyhedron { vertices { x: -0.07 z: -0.1 } "
      "vertices { x: -0.07 z: 0.1 } vertices { x: 0.07 z: -0.1 } } } ";
  const std::string scene = points + Lungs("lung_piston_right: 0.02", "inside: 'body:points' ");
  const Points moved = DisplacementIn(scene).leftCols(3);
  EXPECT_LT(moved(2, 0), -0.008) << "low tissue descends";
  EXPECT_GT(moved(2, 1), moved(2, 0) / 3) << "high tissue less";
  EXPECT_TRUE(moved.col(2).isZero(0)) << "the other lung stays";
}

TEST(LungModes, AreTheOnlyOnesWithTheirParameters) {
  const auto idle = [](const std::string& text) {
    const auto model = CompileText(text);
    const auto& names = model->report.idle_parameters();
    return std::count_if(names.begin(), names.end(), [](const std::string& n) { return n.rfind("lung_", 0) == 0; });
  };
  const std::string at_rest = "name: 'r' bodies { name: 'r' role: ROLE_AT_REST polyhedron { vertices {} } } ";
  EXPECT_EQ(idle(Lungs("")), 1) << "lung_compliance";
  EXPECT_EQ(idle(at_rest), 13);
}

TEST(LungModes, RefuseWhatIsNoLung) {
  const auto fault = [](const std::string& text) { return std::string(TryCompileText(text).status().message()); };
  const std::string named = "motions[0].lung_modes.lungs";
  EXPECT_THAT(fault(Lungs("") + Lung("third", "LEFT", 0.3)), testing::AllOf(HasSubstr(named), HasSubstr("one side")));
  EXPECT_THAT(fault(Lungs("") + "motions { lung_modes { lungs: 'body:r' } }"), HasSubstr("has a motion already"));
  std::string plain = Lungs("");
  plain.replace(plain.find("STRUCTURE_LUNG"), 14, "STRUCTURE_DIAPHRAGM");
  EXPECT_THAT(fault(plain), testing::AllOf(HasSubstr(named), HasSubstr("\"r\" is no lung")));
  std::string open = Lungs("");
  open.replace(open.find("divisions"), 9, "upper_half: true divisions");
  EXPECT_THAT(fault(open), testing::AllOf(HasSubstr(named), HasSubstr("body \"r\"")));
  std::string seen = Lungs("");
  seen.replace(seen.find("ROLE_DEFORMABLE mass: 0.5"), 25, "ROLE_SEEN");
  EXPECT_THAT(fault(seen), HasSubstr(named));
}

TEST(Scale, StretchesAShapeBeforeItsOffset) {
  const std::string body =
      "name: 's' bodies { name: 'b' role: ROLE_AT_REST polyhedron { vertices { x: 1 y: 1 z: 1 } } offset { x: 1 } ";
  const auto model = CompileText(body + "scale { x: 2 y: 3 z: 0.5 } }");
  EXPECT_EQ(model->bodies[0].mesh.vertices.col(0), Eigen::Vector3d(3, 3, 0.5));
  for (const char* bad : {"x: 2 y: 3", "x: -1 y: 1 z: 1", "x: 2000 y: 1 z: 1"}) {
    const auto refused = TryCompileText(body + "scale { " + bad + " } }");
    EXPECT_THAT(std::string(refused.status().message()), HasSubstr("scale: each axis")) << bad;
  }
}

}  // namespace
}  // namespace phrenic
