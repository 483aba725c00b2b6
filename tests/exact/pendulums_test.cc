// Pendulums on rigid links: their motion in angles, their energy, and where they hang.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "absl/strings/str_format.h"
#include "server/mechanics/constraint_residual.h"
#include "tests/compile_text.h"

namespace phrenic {
namespace {

constexpr double kGravity = 9.81, kRod = 0.5;

// `links` masses of 1 kg on rods of half a metre, straight, `angle` from hanging, in the plane of x and z.
std::string Pendulum(int links, double angle, const std::string& integrator, const std::string& more = "") {
  std::string text = "name: 'pendulum' bodies { name: 'rods' role: ROLE_DEFORMABLE mass: " + std::to_string(links + 1) +
                     " fixed_vertices: 0 polyhedron {";
  for (int i = 0; i <= links; ++i) {
    text += absl::StrFormat(" vertices { x: %.17g z: %.17g }", kRod * i * std::sin(angle), -kRod * i * std::cos(angle));
  }
  text +=
      " } } forces { gravity { bodies: 'rods' acceleration { z: -9.81 } } } constraints { rigid_links { body: "
      "'rods' list {";
  for (int i = 0; i < links; ++i) text += " links { a: " + std::to_string(i) + " b: " + std::to_string(i + 1) + " }";
  return text + " } } } " + more + " parameters { integrator: INTEGRATOR_" + integrator + " }";
}

// Angles from hanging and their rates.
using Angles = std::array<double, 4>;

Angles operator+(const Angles& a, const Angles& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]}; }
Angles operator*(double k, const Angles& a) { return {k * a[0], k * a[1], k * a[2], k * a[3]}; }

// The double pendulum of equal masses and rods.
Angles Rates(const Angles& at) {
  const auto [a, b, p, q] = at;
  const double d = a - b, f = kGravity / kRod, below = 3 - std::cos(2 * d);
  return {p, q,
          (-3 * f * std::sin(a) - f * std::sin(a - 2 * b) - 2 * std::sin(d) * (q * q + p * p * std::cos(d))) / below,
          2 * std::sin(d) * (2 * p * p + 2 * f * std::cos(a) + q * q * std::cos(d)) / below};
}

// The place of the lower mass.
Eigen::Vector3d DoublePendulumAt(double seconds, double angle) {
  Angles at = {angle, angle, 0, 0};
  const int steps = static_cast<int>(std::round(seconds / 1e-5));
  const double h = seconds / steps;
  for (int i = 0; i < steps; ++i) {
    const Angles k1 = Rates(at), k2 = Rates(at + h / 2 * k1), k3 = Rates(at + h / 2 * k2), k4 = Rates(at + h * k3);
    at = at + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  return {kRod * (std::sin(at[0]) + std::sin(at[1])), 0, -kRod * (std::cos(at[0]) + std::cos(at[1]))};
}

double DoublePendulumError(const std::string& integrator, double dt) {
  const double seconds = 1, angle = 2;
  const auto model = CompileText(Pendulum(2, angle, integrator));
  const State state = RunTo(*model, seconds, dt);
  return (state.x.col(2) - DoublePendulumAt(seconds, angle)).norm();
}

TEST(DoublePendulum, OfRigidLinksFollowsItsAnglesAtTheOrderOfEachIntegrator) {
  struct Case {
    const char* integrator;
    double dt, order, largest;  // [s], 1, [m]
  };
  const Case cases[] = {{"SEMI_IMPLICIT_EULER", 5e-4, 1, 0.02},
                        {"VELOCITY_VERLET", 2e-3, 2, 1e-3},
                        {"RUNGE_KUTTA_4", 5e-3, 4, 1e-4},
                        {"LINEAR_IMPLICIT_EULER", 2e-5, 1, 0.02},
                        {"BDF2", 5e-4, 2, 1e-3},
                        {"TR_BDF2", 2e-3, 2, 1e-3}};
  for (const auto& [integrator, dt, order, largest] : cases) {
    const double one = DoublePendulumError(integrator, dt), two = DoublePendulumError(integrator, dt / 2);
    EXPECT_LT(one, largest) << integrator;
    EXPECT_NEAR(std::log2(one / two), order, 0.25) << integrator;
  }
}

// Kinetic energy and height, above the lowest that it can have.
double Energy(const Model& model, const State& state) {
  double energy = 0;
  for (int i = 1; i < state.x.cols(); ++i) {
    energy += model.mass[i] * (0.5 * state.v.col(i).squaredNorm() + kGravity * (state.x(2, i) + kRod * i));
  }
  return energy;
}

// The largest energy in 20 s, relative to the first.
double LargestEnergy(int links, const std::string& integrator, double dt) {
  const auto model = CompileText(Pendulum(links, M_PI / 2, integrator));
  State state = model->InitialState();
  const double first = Energy(*model, state);
  Workspace work = model->MakeWorkspace();
  double largest = 0;
  const int steps = static_cast<int>(std::round(20 / dt));
  for (int i = 0; i < steps; ++i) {
    if (const absl::Status stepped = Step(*model, model->parameters, dt, state, work); !stepped.ok()) {
      ADD_FAILURE() << integrator << ", " << links << " links, " << dt << " s, step " << i << ": " << stepped;
      return HUGE_VAL;
    }
    largest = std::max(largest, Energy(*model, state) / first);
  }
  EXPECT_LT(LargestResidual(*model, state).metres, 1e-9) << integrator;
  return largest;
}

TEST(LinkPendulums, GainNoEnergyInTwentySecondsUnderImplicitIntegrators) {
  for (const char* integrator : {"BDF2", "TR_BDF2", "LINEAR_IMPLICIT_EULER"}) {
    for (const double dt : {1e-3, 1e-2, 5e-2}) {
      for (const int links : {1, 2}) EXPECT_LT(LargestEnergy(links, integrator, dt), 1.02) << dt;
    }
  }
}

// A chain that begins level hangs straight down.
TEST(LinkChain, HangsInStaticEquilibrium) {
  const auto model = CompileText(Pendulum(8, 1.5, "STATIC"));
  const State state = RunTo(*model, 0.1, 0.1);
  for (int i = 0; i <= 8; ++i) {
    EXPECT_LT((state.x.col(i) - Eigen::Vector3d(0, 0, -kRod * i)).norm(), 1e-6) << i;
  }
  EXPECT_LT(LargestResidual(*model, state).metres, 1e-9);
}

// Steps of `dt` with this integrator.
State Move(const Model& model, v1::Integrator integrator, int steps, double dt) {
  v1::Parameters parameters = model.parameters;
  parameters.set_integrator(integrator);
  State state = model.InitialState();
  Workspace work = model.MakeWorkspace();
  for (int i = 0; i < steps; ++i) {
    const absl::Status stepped = Step(model, parameters, dt, state, work);
    EXPECT_TRUE(stepped.ok()) << i << ": " << stepped;
    if (!stepped.ok()) break;
  }
  return state;
}

// Figure 5.1's cube stands on its links; a net of links hangs beside springs; a cable that cannot stretch holds a load.
TEST(StaticEquilibrium, WithLinksIsWhereAMotionWithFrictionEnds) {
  const char* const scenes[] = {
      "name: 'cube' bodies { name: 'cube' role: ROLE_DEFORMABLE mass: 8 fixed_vertices: [0, 1, 2, 3] polyhedron { "
      "vertices {} vertices { x: 10 } vertices { x: 10 y: 10 } vertices { y: 10 } vertices { z: 10 } vertices { x: 10 "
      "z: 10 } vertices { x: 10 y: 10 z: 10 } vertices { y: 10 z: 10 } edges { a: 4 b: 5 } edges { a: 5 b: 6 } edges { "
      "a: 6 b: 7 } edges { a: 7 b: 4 } edges { a: 0 b: 4 } edges { a: 1 b: 5 } edges { a: 2 b: 6 } edges { a: 3 b: 7 } "
      "} } forces { springs { bodies: 'cube' stiffness: 20 } } forces { friction { bodies: 'cube' rate: 1 } } forces { "
      "gravity { bodies: 'cube' acceleration { z: -9.81 } } } constraints { rigid_links { body: 'cube' list { links { "
      "a: 0 b: 5 } links { a: 1 b: 6 } links { a: 2 b: 7 } links { a: 3 b: 4 } } } }",
      "name: 'net' bodies { name: 'net' role: ROLE_DEFORMABLE mass: 2 fixed_vertices: [0, 3] grid { columns: 4 rows: 4 "
      "u "
      "{ x: 0.1 } v { y: 0.1 } } } forces { springs { bodies: 'net' stiffness: 300 } } forces { friction { bodies: "
      "'net' rate: 3 } } forces { gravity { bodies: 'net' acceleration { z: -9.81 } } } constraints { rigid_links { "
      "body: 'net' list { links { a: 5 b: 6 } links { a: 6 b: 10 } links { a: 8 b: 12 } links { a: 12 b: 13 } } } }",
      "name: 'rope' bodies { name: 'rope' role: ROLE_DEFORMABLE mass: 5 fixed_vertices: [0, 4] polyhedron { vertices "
      "{} "
      "vertices { x: 1 } vertices { x: 2 } vertices { x: 3 } vertices { x: 3.5 z: 0.5 } } } forces { friction { "
      "bodies: "
      "'rope' rate: 2 } } forces { gravity { bodies: 'rope' acceleration { z: -9.81 } } } constraints { length_limits "
      "{ "
      "body: 'rope' list { links { a: 0 b: 1 } links { a: 1 b: 2 } links { a: 2 b: 3 } links { a: 3 b: 4 } } "
      "at_most_ratio: 1.02 } }"};
  for (const char* text : scenes) {
    const auto model = CompileText(text);
    ASSERT_NE(model, nullptr);
    const State still = Move(*model, v1::INTEGRATOR_STATIC, 1, 0.1);
    const State moved = Move(*model, v1::INTEGRATOR_VELOCITY_VERLET, 60'000, 1e-3);
    EXPECT_LT((still.x - moved.x).cwiseAbs().maxCoeff(), 1e-5 * model->size) << text;
    EXPECT_LT(LargestResidual(*model, still).metres, 1e-9 * model->size) << text;
  }
}

}  // namespace
}  // namespace phrenic
