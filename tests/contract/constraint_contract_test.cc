// The laws that every projection of rigid links keeps, and those that only the exact one does.
#include <gtest/gtest.h>

#include "tests/compile_text.h"

namespace phrenic {
namespace {

// A dumbbell: two masses of 1 kg joined by a link of 1 m.
std::string Dumbbell(const std::string& projection) {
  return "name: 'dumbbell' bodies { name: 'pair' role: ROLE_DEFORMABLE mass: 2 polyhedron { vertices {} vertices { x: "
         "1 "
         "} edges { a: 0 b: 1 } } } constraints { rigid_links { body: 'pair' list { links { a: 0 b: 1 } } "
         "projection: " +
         projection + " } }";
}

State Throw(const Model& model, double dt, int steps) {
  State state = model.InitialState();
  state.v.col(0) = Eigen::Vector3d(2, -3, 0);
  state.v.col(1) = Eigen::Vector3d(2, 3, 1);
  Workspace work = model.MakeWorkspace();
  int done = 0;
  while (done < steps && Step(model, model.parameters, dt, state, work).ok()) ++done;
  EXPECT_EQ(done, steps) << "diverged";
  return state;
}

class ConstraintContract : public testing::TestWithParam<const char*> {};

TEST_P(ConstraintContract, HoldsItsLength) {
  const auto model = CompileText(Dumbbell(GetParam()));
  const State state = Throw(*model, 1e-5, 100'000);
  EXPECT_LT(model->constraints.front()->Residual(state), 1e-9);
}

TEST_P(ConstraintContract, SwitchedOffItDoesNothing) {
  const auto model = CompileText(Dumbbell(GetParam()));
  v1::Parameters off = model->parameters;
  off.set_apply_links(false);
  State state = model->InitialState();
  state.v.col(1) = Eigen::Vector3d(1, 0, 0);
  Workspace work = model->MakeWorkspace();
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(Step(*model, off, 1e-3, state, work).ok());
  EXPECT_NEAR(state.x(0, 1), 2, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Projections, ConstraintContract, testing::Values("PROJECTION_EXACT", "PROJECTION_THESIS"));

TEST(ExactLinks, KeepMomentumAngularMomentumAndEnergy) {
  const auto model = CompileText(Dumbbell("PROJECTION_EXACT"));
  const State state = Throw(*model, 1e-4, 20'000);
  const Eigen::Vector3d momentum = state.v.rowwise().sum();
  EXPECT_LT((momentum - Eigen::Vector3d(4, 0, 1)).norm(), 1e-9);
  const Eigen::Vector3d relative = state.x.col(1) - state.x.col(0), rate = state.v.col(1) - state.v.col(0);
  EXPECT_NEAR(relative.cross(rate).norm(), Eigen::Vector3d::UnitX().cross(Eigen::Vector3d(0, 6, 1)).norm(), 1e-3);
  EXPECT_NEAR(state.v.squaredNorm() / 2, (13.0 + 14.0) / 2, 1e-2);
}

// A chain of links that share vertices, hanging from a fixed one: the thesis could not have two links at one mass.
TEST(ExactLinks, HoldAnyNumberOfLinksAVertex) {
  const auto model = CompileText(
      "name: 'chain' bodies { name: 'chain' role: ROLE_DEFORMABLE mass: 5 fixed_vertices: 0 polyhedron { "
      "vertices {} vertices { x: 1 } vertices { x: 2 } vertices { x: 3 } vertices { x: 4 } } } "
      "forces { gravity { bodies: 'chain' acceleration { z: -9.81 } } } constraints { rigid_links { body: 'chain' list "
      "{ "
      "links { a: 0 b: 1 } links { a: 1 b: 2 } links { a: 2 b: 3 } links { a: 3 b: 4 } } } }");
  const State state = RunTo(*model, 3, 1e-3);
  EXPECT_LT(model->constraints.front()->Residual(state), 1e-8);
}

}  // namespace
}  // namespace phrenic
