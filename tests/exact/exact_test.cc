// Compares simple mechanical systems with exact solutions from textbooks.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "server/mechanics/stability/spectrum.h"
#include "tests/compile_text.h"

namespace phrenic {
namespace {

// Fixed chain of N free masses m and springs k, mode j: omega = 2 sqrt(k/m) sin(j pi / (2 (N + 1))).
TEST(FixedChain, FastestModeMatchesTheClosedForm) {
  constexpr int kFree = 12;
  std::string text =
      "name: 'chain' bodies { name: 'chain' role: ROLE_DEFORMABLE mass: 7 fixed_vertices: [0, 13] polyhedron {";
  for (int i = 0; i <= kFree + 1; ++i) text += " vertices { x: " + std::to_string(i) + " }";
  for (int i = 0; i <= kFree; ++i) text += " edges { a: " + std::to_string(i) + " b: " + std::to_string(i + 1) + " }";
  const auto model = CompileText(text + " } } forces { springs { bodies: 'chain' stiffness: 50 } }");
  const double mass = 7.0 / (kFree + 2);
  const double exact = 2 * std::sqrt(50 / mass) * std::sin(kFree * std::numbers::pi / (2 * (kFree + 1)));
  const FastestMode mode = FindFastestMode(*model, model->parameters, model->InitialState());
  EXPECT_NEAR(mode.spectrum.omega_max, exact, 1e-6 * exact);
}

// Semi-implicit Euler falls -g h^2 n (n + 1) / 2 after n steps, exactly.
TEST(FreeFall, SemiImplicitEulerMatchesItsExactSum) {
  const auto model = CompileText(
      "name: 'fall' bodies { name: 'mass' role: ROLE_DEFORMABLE mass: 3 polyhedron { vertices {} vertices { x: 9 } } } "
      "forces { gravity { bodies: 'mass' acceleration { z: -9.81 } } }");
  const State state = RunTo(*model, 1, 0.01);
  EXPECT_NEAR(state.x(2, 0), -9.81 * 0.01 * 0.01 * 100 * 101 / 2, 1e-12);
}

// Pendulum of 1 m on a rigid link, released at 90 degrees: its period is 4 sqrt(L/g) K(sin 45 deg) = 2.367841948 s. It
// reaches the lowest point after a quarter of it; the time is interpolated between two steps.
double QuarterPeriod(const Model& model, double dt) {
  State state = model.InitialState();
  Workspace work = model.MakeWorkspace();
  double before = state.x(0, 1);
  while (true) {
    EXPECT_TRUE(Step(model, model.parameters, dt, state, work).ok());
    if (state.x(0, 1) <= 0) return state.time - dt * (-state.x(0, 1)) / (before - state.x(0, 1));
    before = state.x(0, 1);
  }
}

TEST(Pendulum, OnAnExactLinkHasTheEllipticPeriodInTheLimit) {
  const auto model = CompileText(
      "name: 'pendulum' bodies { name: 'rod' role: ROLE_DEFORMABLE mass: 2 fixed_vertices: 0 polyhedron { vertices {} "
      "vertices { x: 1 } edges { a: 0 b: 1 } } } forces { gravity { bodies: 'rod' acceleration { z: -9.81 } } } "
      "constraints { rigid_links { body: 'rod' list { links { a: 0 b: 1 } } } }");
  const double exact = 2.367841948 / 4;
  const double coarse = std::abs(QuarterPeriod(*model, 1e-3) - exact);
  const double fine = std::abs(QuarterPeriod(*model, 1e-4) - exact);
  EXPECT_LT(coarse, 1e-3);
  EXPECT_LT(fine, 0.2 * coarse);
}

// With RATTLE the same pendulum converges at second order and keeps its energy for a hundred swings.
TEST(Pendulum, OnAnExactLinkIsOfSecondOrderByVerlet) {
  const auto model = CompileText(
      "name: 'pendulum' bodies { name: 'rod' role: ROLE_DEFORMABLE mass: 2 fixed_vertices: 0 polyhedron { vertices {} "
      "vertices { x: 1 } edges { a: 0 b: 1 } } } forces { gravity { bodies: 'rod' acceleration { z: -9.81 } } } "
      "constraints { rigid_links { body: 'rod' list { links { a: 0 b: 1 } } } } "
      "parameters { integrator: INTEGRATOR_VELOCITY_VERLET }");
  const double exact = 2.367841948 / 4;
  const double coarse = std::abs(QuarterPeriod(*model, 1e-2) - exact);
  EXPECT_LT(coarse, 1e-3);
  EXPECT_LT(std::abs(QuarterPeriod(*model, 1e-3) - exact), 0.05 * coarse);
  const State late = RunTo(*model, 236.7841948, 1e-2);
  const double energy = 0.5 * late.v.col(1).squaredNorm() + 9.81 * late.x(2, 1);  // of a mass of 1 kg; initially 0
  EXPECT_LT(std::abs(energy), 1e-2 * 9.81);
}

// Hanging chain of N equal springs: spring j carries the masses below it and stretches by that load over k.
TEST(HangingChain, SettlesToTheClosedForm) {
  constexpr int kMasses = 6;
  std::string text =
      "name: 'hang' bodies { name: 'chain' role: ROLE_DEFORMABLE mass: 0.7 fixed_vertices: 0 polyhedron {";
  for (int i = 0; i <= kMasses; ++i) text += " vertices { z: " + std::to_string(-0.1 * i) + " }";
  for (int i = 0; i < kMasses; ++i) text += " edges { a: " + std::to_string(i) + " b: " + std::to_string(i + 1) + " }";
  const auto model =
      CompileText(text +
                  " } } forces { springs { bodies: 'chain' stiffness: 60 } } forces { gravity { bodies: "
                  "'chain' acceleration { z: -9.81 } } } forces { friction { bodies: 'chain' rate: 8 } }");
  const State state = RunTo(*model, 60, 5e-3);
  double end = 0;
  for (int spring = 0; spring < kMasses; ++spring) end -= 0.1 + (kMasses - spring) * 0.1 * 9.81 / 60;
  EXPECT_NEAR(state.x(2, kMasses), end, 1e-9);
}

}  // namespace
}  // namespace phrenic
