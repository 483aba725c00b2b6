// How a body's mass is spread over its vertices.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <vector>

#include "absl/strings/str_cat.h"
#include "server/mechanics/step/step_plan.h"
#include "tests/compile_text.h"

namespace phrenic {
namespace {

// Soft on one side and stiff on the other, held at a corner, small triangles in the last column, pulled by a muscle.
std::string TwoStiffnesses(const std::string& mass_lumping) {
  return absl::StrCat(
      "name: 'sheet' bodies { name: 'sheet' role: ROLE_DEFORMABLE mass: 2 fixed_vertices: [0] ", mass_lumping,
      " grid { columns: 12 rows: 9 u { x: 0.01 } v { y: 0.01 } } regions { name: 'stiff' low { x: 0.055 y: -1 z: -1 } "
      "high { x: 1 y: 1 z: 1 } } } "
      "forces { springs { bodies: 'sheet' region: 'stiff' stiffness: 90 } } "
      "forces { springs { bodies: 'sheet' exclude_region: 'stiff' stiffness: 10 } } "
      "forces { gravity { bodies: 'sheet' acceleration { z: -9.81 } } } "
      "forces { friction { bodies: 'sheet' rate: 3 } } "
      "forces { action_line { bodies: 'sheet' origin {} direction { z: -1 } radius: 0.3 force: 2 } } "
      "parameters { breath_force: 1 }");
}

const char kByStiffness[] = "mass_lumping: MASS_LUMPING_BY_STIFFNESS";

// What each vertex meets where the others stay.
class StiffnessAt final : public StiffnessSink {
 public:
  explicit StiffnessAt(Eigen::Index vertices) : own(vertices, Eigen::Matrix3d::Zero()) {}
  void Add(int i, int j, const Eigen::Matrix3d& block) override {
    if (i == j) own[i] += block;
  }
  void AddOuter(double, const Points&) override {}
  std::vector<Eigen::Matrix3d> own;
};

TEST(Masses, AreSpreadByTheLargestStiffnessDownToHalfAnEqualShare) {
  const auto model = CompileText(TwoStiffnesses(kByStiffness));
  ASSERT_NE(model, nullptr);
  StiffnessAt stiffness(model->rest.cols());
  const State rest = model->InitialState();
  for (const auto& force : model->forces)
    force->AddStiffness(MakeEvalContext(*model, model->parameters, rest), stiffness);
  Eigen::VectorXd largest(model->rest.cols());
  for (Eigen::Index i = 0; i < largest.size(); ++i) largest[i] = stiffness.own[i].operatorNorm();
  EXPECT_NEAR(model->mass.sum(), 2, 1e-12);
  const Eigen::VectorXd raised = largest.cwiseMax(0.5 * largest.mean());
  EXPECT_LT((model->mass - raised * (2 / raised.sum())).norm(), 1e-9)
      << "the eigenvalues have a closed form, right to 1e-8";
  EXPECT_EQ(model->inverse_mass[0], 0);
  EXPECT_DOUBLE_EQ(model->inverse_mass[5], 1 / model->mass[5]);
}

TEST(Masses, ByStiffnessLetExplicitStepsBeLonger) {
  const auto by_area = CompileText(TwoStiffnesses("")), by_stiffness = CompileText(TwoStiffnesses(kByStiffness));
  ASSERT_NE(by_stiffness, nullptr);
  EXPECT_GT(by_stiffness->report.stable_step().seconds(), 1.2 * by_area->report.stable_step().seconds());
}

// Weight, friction and a muscle's pull: where a body comes to rest does not depend on how its inertia is spread.
TEST(Masses, ByStiffnessLeaveWhatActsAsItIs) {
  const auto by_area = CompileText(TwoStiffnesses("")), by_stiffness = CompileText(TwoStiffnesses(kByStiffness));
  ASSERT_NE(by_stiffness, nullptr);
  const auto force = [](const Model& model) {
    State state = model.InitialState();
    state.phase = 0.25;
    state.v.setConstant(0.1);
    Points f(3, model.rest.cols());
    model.plan->SumForces(MakeEvalContext(model, model.parameters, state), f);
    return f;
  };
  EXPECT_GT(force(*by_area).norm(), 0);
  EXPECT_EQ(force(*by_area), force(*by_stiffness));
}

TEST(Masses, ByStiffnessOfNothingAreRefusedByField) {
  const auto model = TryCompileText(
      "name: 'ball' bodies { name: 'ball' role: ROLE_DEFORMABLE mass_lumping: MASS_LUMPING_BY_STIFFNESS grid { "
      "columns: "
      "2 "
      "rows: 2 u { x: 1 } v { y: 1 } } } forces { gravity { bodies: 'ball' acceleration { z: -9.81 } } }");
  ASSERT_FALSE(model.ok());
  EXPECT_EQ(model.status().message(),
            "bodies[0].mass_lumping: nothing in the scene resists a motion of the body: leave MASS_LUMPING_BY_AREA");
}

}  // namespace
}  // namespace phrenic
