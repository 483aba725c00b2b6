// How a body's mass is spread over its vertices.
#include <gtest/gtest.h>

#include "absl/strings/str_cat.h"
#include "tests/compile_text.h"

namespace phrenic {
namespace {

// Soft on one side and stiff on the other, held at a corner, small triangles in the last column, pulled by a muscle.
std::string TwoStiffnesses(const std::string& mass_shares) {
  return absl::StrCat(
      "name: 'sheet' bodies { name: 'sheet' role: ROLE_DEFORMABLE mass: 2 fixed_vertices: [0] ", mass_shares,
      " grid { columns: 12 rows: 9 u { x: 0.01 } v { y: 0.01 } } regions { name: 'stiff' low { x: 0.055 y: -1 z: -1 } "
      "high { x: 1 y: 1 z: 1 } } } "
      "forces { springs { bodies: 'sheet' region: 'stiff' stiffness: 90 } } "
      "forces { springs { bodies: 'sheet' exclude_region: 'stiff' stiffness: 10 } } "
      "forces { action_line { bodies: 'sheet' origin {} direction { z: -1 } radius: 0.3 force: 2 } } "
      "parameters { breath_force: 1 }");
}

const char kByStiffness[] = "mass_shares: MASS_SHARES_BY_STIFFNESS";

// The sum of the stiffness of all springs at each vertex.
class StiffnessAt final : public StiffnessSink {
 public:
  explicit StiffnessAt(Eigen::Index vertices) : sum(Eigen::VectorXd::Zero(vertices)) {}
  // At rest length a spring's is k along it, and nothing across.
  void Add(int i, int j, const Eigen::Matrix3d& block) override {
    if (i == j) sum[i] += block.trace();
  }
  void AddOuter(double, const Points&) override {}
  Eigen::VectorXd sum;
};

TEST(Masses, AreSpreadByStiffnessDownToHalfAnEqualShare) {
  const auto model = CompileText(TwoStiffnesses(kByStiffness));
  ASSERT_NE(model, nullptr);
  StiffnessAt stiffness(model->rest.cols());
  const State rest = model->InitialState();
  for (const auto& force : model->forces) force->AddStiffness(MakeInstant(*model, model->parameters, rest), stiffness);
  EXPECT_NEAR(model->mass.sum(), 2, 1e-12);
  const Eigen::VectorXd raised = stiffness.sum.cwiseMax(0.5 * stiffness.sum.mean());
  EXPECT_LT((model->mass - raised * (2 / raised.sum())).norm(), 1e-12);
  EXPECT_EQ(model->inverse_mass[0], 0);
  EXPECT_DOUBLE_EQ(model->inverse_mass[5], 1 / model->mass[5]);
}

TEST(Masses, ByStiffnessLetExplicitStepsBeLonger) {
  const auto by_area = CompileText(TwoStiffnesses("")), by_stiffness = CompileText(TwoStiffnesses(kByStiffness));
  ASSERT_NE(by_stiffness, nullptr);
  EXPECT_GT(by_stiffness->report.stable_step().seconds(), 1.2 * by_area->report.stable_step().seconds());
}

TEST(Masses, LeaveWhatAMusclePullsWhereByAreaAsItIs) {
  const auto by_area = CompileText(TwoStiffnesses("")), by_stiffness = CompileText(TwoStiffnesses(kByStiffness));
  ASSERT_NE(by_stiffness, nullptr);
  const auto pull = [](const Model& model) {
    State state = model.InitialState();
    state.phase = 0.25;
    Points f = Points::Zero(3, model.rest.cols());
    model.forces.back()->AddForce(MakeInstant(model, model.parameters, state), f);
    return f;
  };
  EXPECT_GT(pull(*by_area).norm(), 0);
  EXPECT_EQ(pull(*by_area), pull(*by_stiffness));
}

TEST(Masses, ByStiffnessOfNoSpringsAreRefusedByField) {
  const auto model = TryCompileText(
      "name: 'ball' bodies { name: 'ball' role: ROLE_DEFORMABLE mass_shares: MASS_SHARES_BY_STIFFNESS grid { columns: "
      "2 "
      "rows: 2 u { x: 1 } v { y: 1 } } } forces { gravity { bodies: 'ball' acceleration { z: -9.81 } } }");
  ASSERT_FALSE(model.ok());
  EXPECT_EQ(model.status().message(),
            "bodies[0].mass_shares: no spring of the scene acts on the body: leave MASS_SHARES_BY_AREA");
}

}  // namespace
}  // namespace phrenic
