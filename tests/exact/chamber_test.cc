// Compares volumes, pressures and lungs with closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mechanics/step/step_plan.h"
#include "tests/compile_text.h"
#include "tests/static_solve.h"

namespace phrenic {
namespace {

constexpr double kPi = std::numbers::pi;

double Reading(const Model& model, const State& state, const std::string& name) {
  for (const auto& measure : model.measures) {
    if (measure->name() == name) return measure->Value(MakeEvalContext(model, model.parameters, state));
  }
  ADD_FAILURE() << "no measure " << name;
  return 0;
}

std::string Sphere(int divisions) {
  return absl::StrFormat(
      "name: 'sphere' bodies { name: 'ball' role: ROLE_DEFORMABLE mass: 0.5 ellipsoid { centre { x: 3 y: -2 z: 5 } "
      "radii { x: 0.2 y: 0.2 z: 0.2 } divisions: %d } } measures { name: 'V' volume { surface { bodies: 'ball' } } } "
      "measures { name: 'flow' flow { surface { bodies: 'ball' } } } ",
      divisions);
}

// r = R (1 + sin(omega t)/4): V = 4 pi r^3/3 and its rate, at any time of the breath, at second order in the mesh size.
TEST(BreathingSphere, HasTheVolumeAndFlowOfTheClosedForm) {
  constexpr double kRadius = 0.2, kOmega = 3;
  const auto worst = [&](int divisions) {
    const auto model = CompileText(Sphere(divisions));
    State state = model->InitialState();
    double off = 0;
    for (const double time : {0.0, 0.2, 0.5, 0.9, 1.4}) {
      const double scale = 1 + std::sin(kOmega * time) / 4, rate = kOmega * std::cos(kOmega * time) / 4;
      const Points arms = model->rest.colwise() - Eigen::Vector3d(3, -2, 5);
      state.x = (scale * arms).colwise() + Eigen::Vector3d(3, -2, 5);
      state.v = rate * arms;
      const double r = scale * kRadius, volume = 4 * kPi * r * r * r / 3;
      off = std::max(off, std::abs(Reading(*model, state, "V") / volume - 1));
      const double flow = 4 * kPi * r * r * rate * kRadius;
      off = std::max(off, std::abs(Reading(*model, state, "flow") / flow - 1));
    }
    return off;
  };
  const double coarse = worst(8), fine = worst(16);
  EXPECT_LT(fine, 0.01);
  EXPECT_NEAR(coarse / fine, 4, 0.2);
}

// A gas in a sphere without stiffness, or lungs with a resistance, for small amplitudes: V'' + R S V' + S/C (V - V0) =
// 0, S = sum |a_i|^2/m_i, about (4 pi r^2)^2/m. The initial velocities along a_i/m_i give the flow V'(0).
struct Gas {
  const char* force;
  double resistance;
};

class GasInASphere : public testing::TestWithParam<Gas> {};

double VolumeErrorAfter(const Gas& gas, const std::string& integrator, double dt) {
  constexpr double kCompliance = 2e-5, kFlow = 1e-6, kTime = 0.05;
  const auto model = CompileText(Sphere(5) + gas.force + " parameters { integrator: " + integrator + " }");
  State state = model->InitialState();
  Points area = Points::Zero(3, state.x.cols());
  for (Eigen::Index i = 0; i < area.size(); ++i) {
    State moved = state;
    moved.v.setZero();
    moved.v.data()[i] = 1;
    area.data()[i] = Reading(*model, moved, "flow");
  }
  const double s = (area * model->inverse_mass.asDiagonal()).cwiseProduct(area).sum();
  state.v = kFlow / s * area * model->inverse_mass.asDiagonal();
  Workspace work = model->MakeWorkspace();
  const double before = Reading(*model, state, "V");
  for (long i = 0; i < std::lround(kTime / dt); ++i) {
    EXPECT_TRUE(Step(*model, model->parameters, dt, state, work).ok());
  }
  const double decay = gas.resistance * s / 2, omega = std::sqrt(s / kCompliance - decay * decay);
  const double exact = kFlow / omega * std::exp(-decay * kTime) * std::sin(omega * kTime);
  return std::abs(Reading(*model, state, "V") - before - exact) / (kFlow / omega);
}

TEST_P(GasInASphere, OscillatesAsTheClosedForm) {
  for (const std::string integrator : {"INTEGRATOR_VELOCITY_VERLET", "INTEGRATOR_BDF2", "INTEGRATOR_TR_BDF2"}) {
    const double coarse = VolumeErrorAfter(GetParam(), integrator, 1e-3);
    const double fine = VolumeErrorAfter(GetParam(), integrator, 5e-4);
    EXPECT_LT(fine, 0.02) << integrator;
    EXPECT_LT(fine, 0.35 * coarse) << integrator << " is of second order, including the coupled damping";
  }
}

INSTANTIATE_TEST_SUITE_P(
    Gases, GasInASphere,
    testing::Values(Gas{"forces { pressure { surface { bodies: 'ball' } compliance: 2e-5 } }", 0},
                    Gas{"forces { lungs { walls { bodies: 'ball' } compliance: 2e-5 resistance: 30 } }", 30}));

// A piston of 0.06 m^2 below the lungs moves by a sine: volume, flow and pressures have closed forms.
TEST(LungsOverAPiston, FollowTheEquationOfMotion) {
  const auto model = CompileText(
      "name: 'piston' bodies { name: 'piston' role: ROLE_DEFORMABLE grid { columns: 3 rows: 2 u { x: 0.1 } v { y: 0.3 "
      "} "
      "} } motions { oscillation { body: 'piston' vertices: [0, 1, 2, 3, 4, 5] amplitude { z: -0.004 } period: 4 } } "
      "forces { name: 'lungs' lungs { floor { bodies: 'piston' } compliance: 2e-6 resistance: 2e5 rest_pressure: -400 "
      "rest_volume: 0.003 } } "
      "measures { name: 'V' force_output { force: 'lungs' output: 'volume' } } "
      "measures { name: 'flow' force_output { force: 'lungs' output: 'flow' } } "
      "measures { name: 'alveolar' force_output { force: 'lungs' output: 'alveolar_pressure' } } "
      "measures { name: 'pleural' force_output { force: 'lungs' output: 'pleural_pressure' } }");
  for (const double time : {0.0, 0.3, 1.0, 1.7, 3.2}) {
    const State state = RunTo(*model, time, 0.01);
    const double omega = 2 * kPi / 4, breath = 0.06 * 0.004;
    const double change = breath * std::sin(omega * time), flow = breath * omega * std::cos(omega * time);
    EXPECT_NEAR(Reading(*model, state, "V"), 0.003 + change, 1e-12);
    EXPECT_NEAR(Reading(*model, state, "flow"), flow, 1e-12);
    EXPECT_NEAR(Reading(*model, state, "alveolar"), -2e5 * flow, 1e-7);
    EXPECT_NEAR(Reading(*model, state, "pleural"), -400 - 2e5 * flow - change / 2e-6, 1e-7);
  }
}

// A circular membrane of radius R = 0.1 m under the tension T, with a fixed rim (to half a spacing), deflects by
// p R^2/(4 T) at its centre. A hexagonal lattice of springs of length a and tension f has T = sqrt(3) f/a.
double DepthOverExact(int cells) {
  constexpr double kRadius = 0.1, kStiffness = 40, kRatio = 0.5;
  const double a = kRadius / cells;
  std::string vertices, triangles, fixed;
  std::vector<int> indices(static_cast<size_t>((2 * cells + 5) * (4 * cells + 9)), -1);
  const int half = cells + 2;
  const auto vertex_at = [&](int column, int row) -> int& {
    return indices[static_cast<size_t>((row + half) * (4 * cells + 9) + column + 2 * half)];
  };
  int count = 0;
  for (int row = -half; row <= half; ++row) {
    for (int column = -2 * half; column <= 2 * half; ++column) {
      const double x = a * (column + 0.5 * row), y = a * std::sqrt(0.75) * row, r = std::hypot(x, y);
      if (r > kRadius + a / 2) continue;
      absl::StrAppend(&vertices, absl::StrFormat(" vertices { x: %.17g y: %.17g }", x, y));
      if (r >= kRadius - a / 2) absl::StrAppend(&fixed, " fixed_vertices: ", count);
      vertex_at(column, row) = count++;
    }
  }
  for (int row = -half; row < half; ++row) {
    for (int column = -2 * half; column < 2 * half; ++column) {
      const int right = vertex_at(column + 1, row), up = vertex_at(column, row + 1);
      if (right < 0 || up < 0) continue;
      const int here = vertex_at(column, row), across = vertex_at(column + 1, row + 1);
      if (here >= 0) absl::StrAppend(&triangles, absl::StrFormat(" triangles { a: %d b: %d c: %d }", here, right, up));
      if (across >= 0) {
        absl::StrAppend(&triangles, absl::StrFormat(" triangles { a: %d b: %d c: %d }", right, across, up));
      }
    }
  }
  const double tension = std::sqrt(3) * kStiffness * (1 - kRatio), exact = 1e-4,
               p = 4 * tension * exact / kRadius / kRadius;
  const auto model = CompileText(
      "name: 'drum' bodies { name: 'drum' role: ROLE_DEFORMABLE polyhedron {" + vertices + triangles + " }" + fixed +
      absl::StrFormat(" } forces { springs { bodies: 'drum' stiffness: %g rest_length_ratio: "
                      "%g } } forces { pressure { surface { bodies: 'drum' } pressure: %.17g "
                      "} } measures { name: 'top' highest { body: 'drum' } }",
                      kStiffness, kRatio, p));
  State state = model->InitialState();
  const Points none = Points::Zero(3, state.x.cols());
  state.x = SolveStatic(*model, state.x, none, [&](int i, int) { return model->inverse_mass[i] == 0; });
  return Reading(*model, state, "top") / exact;
}

TEST(MembraneUnderPressure, DeflectsAsTheClosedFormOfACircularOne) {
  const double coarse = DepthOverExact(8), fine = DepthOverExact(32);
  EXPECT_NEAR(fine, 1, 0.02);
  EXPECT_LT(std::abs(fine - 1), 0.5 * std::abs(coarse - 1));
}

}  // namespace
}  // namespace phrenic
