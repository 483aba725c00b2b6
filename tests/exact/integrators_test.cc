// Compares integrators with motions that have a closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/compile_text.h"

namespace phrenic {
namespace {

// A chain along x of `free` masses of 0.5 kg between two fixed ends, springs of 50 N/m and 1 m.
std::string Chain(int free, const std::string& more) {
  std::string text =
      "name: 'chain' bodies { name: 'chain' role: ROLE_DEFORMABLE mass: " + std::to_string(0.5 * (free + 2)) +
      " fixed_vertices: [0, " + std::to_string(free + 1) + "] polyhedron {";
  for (int i = 0; i <= free + 1; ++i) text += " vertices { x: " + std::to_string(i) + " }";
  for (int i = 0; i <= free; ++i) text += " edges { a: " + std::to_string(i) + " b: " + std::to_string(i + 1) + " }";
  return text + " } } forces { springs { bodies: 'chain' stiffness: 50 } } " + more;
}

std::string By(const std::string& integrator) { return "parameters { integrator: INTEGRATOR_" + integrator + " }"; }

// Two equal masses on a spring, both with friction: their distance is a damped oscillator of frequency sqrt(2 k/m).
double TwoMassesError(const std::string& integrator, double dt) {
  const auto model = CompileText(
      "name: 'pair' bodies { name: 'pair' role: ROLE_DEFORMABLE mass: 2 polyhedron { vertices {} vertices { x: 1.25 } "
      "edges { a: 0 b: 1 } } } forces { springs { bodies: 'pair' stiffness: 30 rest_length_ratio: 0.8 } } forces { "
      "friction { bodies: 'pair' rate: 1.5 } } " +
      By(integrator));
  const State state = RunTo(*model, 1, dt);
  const double c = 1.5, omega = std::sqrt(60 - c * c / 4);
  const double exact = 1 + 0.25 * std::exp(-c / 2) * (std::cos(omega) + c / (2 * omega) * std::sin(omega));
  return std::abs(state.x(0, 1) - state.x(0, 0) - exact);
}

TEST(TwoMasses, OnADampedSpringFollowTheClosedFormAtTheirOrder) {
  const auto order = [](const std::string& integrator) {
    return std::log2(TwoMassesError(integrator, 2e-3) / TwoMassesError(integrator, 1e-3));
  };
  EXPECT_NEAR(order("SEMI_IMPLICIT_EULER"), 1, 0.1);
  EXPECT_NEAR(order("VELOCITY_VERLET"), 2, 0.1);
  EXPECT_LT(TwoMassesError("VELOCITY_VERLET", 1e-3), 1e-5);
}

// Mode j of the fixed chain has the frequency 2 sqrt(k/m) sin(j pi / (2 (N + 1))) and keeps its shape.
TEST(FixedChain, KeepsTheShapeAndTheFrequencyOfAMode) {
  constexpr int kFree = 9, kMode = 3;
  const auto model = CompileText(Chain(kFree, By("VELOCITY_VERLET")));
  const double omega = 2 * std::sqrt(50 / 0.5) * std::sin(kMode * std::numbers::pi / (2 * (kFree + 1)));
  const auto error = [&](int steps) {
    State state = model->InitialState();
    for (int i = 1; i <= kFree; ++i) state.x(0, i) += 0.05 * std::sin(i * kMode * std::numbers::pi / (kFree + 1));
    const Points start = state.x;
    Workspace work = model->MakeWorkspace();
    const double dt = 2 * std::numbers::pi / omega / steps;
    for (int i = 0; i < steps; ++i) EXPECT_TRUE(Step(*model, model->parameters, dt, state, work).ok());
    return (state.x - start).cwiseAbs().maxCoeff();  // the state repeats after a period, except for the time error
  };
  EXPECT_LT(error(400), 1e-5);
  EXPECT_NEAR(std::log2(error(200) / error(400)), 4, 0.3);  // the cosine has zero slope there: twice the order
}

// Elastic catenary of point masses: every spring carries the same horizontal force H and the weight below it. The span
// determines H, found here by bisection.
TEST(Catenary, OfPointMassesHangsAsItsDiscreteSolution) {
  constexpr int kFree = 9;
  constexpr double kWeight = 0.5 * 9.81, kStiffness = 50;
  const auto model =
      CompileText(Chain(kFree, "forces { gravity { bodies: 'chain' acceleration { z: -9.81 } } } " + By("STATIC")));
  const auto hang = [&](double pull) {
    Points x = Points::Zero(3, kFree + 2);
    for (int s = 0; s <= kFree; ++s) {
      const double lift = kWeight * (s - kFree / 2.0);  // vertical force on the right of mass s
      const double tension = std::hypot(pull, lift), length = 1 + tension / kStiffness;
      x.col(s + 1) = x.col(s) + length / tension * Eigen::Vector3d(pull, 0, lift);
    }
    return x;
  };
  double low = 1e-6, high = 1e3;
  for (int i = 0; i < 200; ++i) {
    const double middle = (low + high) / 2;
    (hang(middle)(0, kFree + 1) < kFree + 1 ? low : high) = middle;
  }
  const State state = RunTo(*model, 0.1, 0.1);
  EXPECT_LT((state.x - hang(low)).cwiseAbs().maxCoeff(), 1e-8);
}

// A pendulum of 1 m on a spring of 1e7 N/m, released at 90 degrees, reaches the lowest point after a quarter of its
// period of 2.367841948 s. An explicit integrator needs steps below 0.63 ms.
double StiffPendulumError(const std::string& integrator, double dt) {
  const auto model = CompileText(
      "name: 'pendulum' bodies { name: 'rod' role: ROLE_DEFORMABLE mass: 2 fixed_vertices: 0 polyhedron { vertices {} "
      "vertices { x: 1 } edges { a: 0 b: 1 } } } forces { springs { bodies: 'rod' stiffness: 1e7 } } forces { gravity "
      "{ bodies: 'rod' acceleration { z: -9.81 } } } " +
      By(integrator));
  return std::abs(RunTo(*model, 2.367841948 / 4, 2.367841948 / 4 / std::round(0.592 / dt)).x(0, 1));
}

TEST(StiffPendulum, ImplicitMethodsAreAccurateFarAboveTheExplicitLimit) {
  for (const char* integrator : {"BDF2", "TR_BDF2"}) {
    EXPECT_LT(StiffPendulumError(integrator, 4e-3), 5e-3) << integrator;
    EXPECT_LT(StiffPendulumError(integrator, 2e-3), 0.4 * StiffPendulumError(integrator, 4e-3)) << integrator;
  }
  EXPECT_LT(StiffPendulumError("LINEAR_IMPLICIT_EULER", 1e-3), 0.4 * StiffPendulumError("LINEAR_IMPLICIT_EULER", 4e-3));
}

}  // namespace
}  // namespace phrenic
