// Compares point loads, target springs and pulls with closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "server/mechanics/pulls.h"
#include "tests/compile_text.h"

namespace phrenic {
namespace {

// Two masses of 1.5 kg far apart, with the elements `more`.
std::shared_ptr<const Model> Masses(const std::string& more, const std::string& breath_force = "1",
                                    const std::string& integrator = "VELOCITY_VERLET") {
  return CompileText(
      "name: 'masses' bodies { name: 'masses' role: ROLE_DEFORMABLE mass: 3 polyhedron { vertices {} vertices { x: 9 } "
      "} regions { name: 'both' low {} high { x: 9 } } } bodies { name: 'slope' role: ROLE_AT_REST polyhedron { "
      "vertices { x: -99 y: -99 z: -101 } vertices { x: 99 y: -99 z: 97 } vertices { y: 99 z: -2 } triangles { a: 0 b: "
      "1 c: 2 } } } breath { waveform: WAVEFORM_RAISED_COSINE } forces { " +
      more + " } parameters { integrator: INTEGRATOR_" + integrator + " breath_force: " + breath_force + " }");
}

// A damped oscillator released off its target: x = d (1 - e^(-zeta w t) (cos w' t + zeta w/w' sin w' t)).
TEST(TargetSpring, IsADampedOscillatorAboutItsTarget) {
  const auto model =
      Masses("target_spring { bodies: 'masses' displacement { z: 0.2 } stiffness: 60 damping_ratio: 0.3 }");
  const double omega = std::sqrt(60 / 1.5), t = 0.7, damped = omega * std::sqrt(1 - 0.3 * 0.3);
  const double exact =
      0.2 * (1 - std::exp(-0.3 * omega * t) * (std::cos(damped * t) + 0.3 * omega / damped * std::sin(damped * t)));
  const double coarse = std::abs(RunTo(*model, t, 1e-2).x(2, 1) - exact);
  const double fine = std::abs(RunTo(*model, t, 1e-3).x(2, 1) - exact);
  EXPECT_LT(fine, 2e-6);
  EXPECT_LT(fine, 0.03 * coarse) << "second order";
}

TEST(TargetSpring, EndsAtTheNearestPointOfASurface) {
  const auto model = Masses("target_spring { bodies: 'masses' vertices: 0 surface: 'slope' damping_ratio: 1 }");
  const State state = RunTo(*model, 10, 1e-2);
  // The nearest point of the plane z = x - 2 to the origin is (1, 0, -1).
  EXPECT_LT((state.x.col(0) - Eigen::Vector3d(1, 0, -1)).norm(), 1e-9);
  EXPECT_EQ(state.x.col(1), model->rest.col(1));
}

TEST(TargetSpring, WithTheBreathFollowsItsSignal) {
  const auto model = Masses("target_spring { bodies: 'masses' point { z: 4 } damping_ratio: 0 scaled_by_breath: true }",
                            "0.5", "STATIC");
  const State state = RunTo(*model, 1, 0.01);  // a quarter of 4 s: the signal is 1/2
  EXPECT_LT((state.x.col(1) - (9 * Eigen::Vector3d::UnitX() + 0.25 * Eigen::Vector3d(-9, 0, 4))).norm(), 1e-9);
}

TEST(PointLoad, IsDistributedEvenly) {
  const auto model = Masses("point_load { body: 'masses' region: 'both' force { y: 6 } }");
  const State state = RunTo(*model, 2, 1e-2);
  for (int i = 0; i < 2; ++i) EXPECT_NEAR(state.x(1, i), 3 / 1.5 * 2 * 2 / 2, 1e-12) << i;
}

// m x'' = F (1 - cos w t)/2, so that x = F/(2 m) (t^2/2 + (cos w t - 1)/w^2).
TEST(PointLoad, WithTheBreathIsTheSignalsDoubleIntegral) {
  const auto model = Masses("point_load { body: 'masses' vertices: 1 force { z: 2 } scaled_by_breath: true }", "3");
  const double omega = 2 * std::numbers::pi / 4, t = 3;
  const double exact = 3 * 2 / (2 * 1.5) * (t * t / 2 + (std::cos(omega * t) - 1) / (omega * omega));
  EXPECT_NEAR(RunTo(*model, t, 1e-3).x(2, 1), exact, 1e-5);
  EXPECT_EQ(RunTo(*model, t, 1e-3).x(2, 0), 0);
}

TEST(Pull, StretchesASpringByForceOverStiffness) {
  const auto model = CompileText(
      "name: 'spring' bodies { name: 'spring' role: ROLE_DEFORMABLE fixed_vertices: 0 polyhedron { vertices {} "
      "vertices "
      "{ x: 1 } edges { a: 0 b: 1 } } } forces { springs { bodies: 'spring' stiffness: 40 } } parameters { integrator: "
      "INTEGRATOR_STATIC }");
  State state = model->InitialState();
  Workspace work = model->MakeWorkspace();
  state.pulls = {{1, {3, 0, 0}}};
  ASSERT_TRUE(Step(*model, model->parameters, 0.1, state, work).ok());
  EXPECT_NEAR(state.x(0, 1), 1 + 3.0 / 40, 1e-9);
}

}  // namespace
}  // namespace phrenic
