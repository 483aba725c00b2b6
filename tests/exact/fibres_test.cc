// Muscle fibres: their directions, their shortening and their pull.
#include "server/mechanics/forces/fibres.h"

#include <gtest/gtest.h>

#include "server/mesh/harmonic.h"
#include "tests/compile_text.h"
#include "tests/static_solve.h"

namespace phrenic {
namespace {

// 0.4 x 0.2 m; fibres of 1000 Pa with an active stress of 100 Pa run from its left to its right edge.
std::shared_ptr<const Model> Strip() {
  return CompileText(
      "name: 'strip' bodies { name: 'strip' role: ROLE_DEFORMABLE grid { columns: 9 rows: 5 u { x: 0.05 } v { y: 0.05 "
      "} "
      "} regions { name: 'left' low {} high { y: 1 } } regions { name: 'right' low { x: 0.4 } high { x: 0.4 y: 1 } } } "
      "forces { fibres { bodies: 'strip' from_region: 'left' to_region: 'right' modulus_along: 1000 thickness: 0.01 "
      "active_stress: 100 } } breath { waveform: WAVEFORM_SINE }");
}

TEST(Fibres, RunFromOneRegionToTheOther) {
  const auto model = Strip();
  const Points directions = dynamic_cast<const Fibres&>(*model->forces.front()).Directions();
  EXPECT_EQ(directions.cols(), 8 * 4 * 2);
  EXPECT_LT((directions.colwise() - Eigen::Vector3d::UnitX()).cwiseAbs().maxCoeff(), 1e-9);
}

// Free fibres shorten until their elasticity balances the active stress: by active stress / modulus.
TEST(Fibres, ShortenByActiveStressOverModulus) {
  const auto model = Strip();
  State state = model->InitialState();
  state.phase = 0.25;  // the signal is 1
  state.x.row(0) *= 1 - 100.0 / 1000;
  EXPECT_LT(ForceOn(*model, state).cwiseAbs().maxCoeff(), 1e-12);
}

// Fixed fibres pull on each end with active stress x cross-section; not with muscles off, nor in expiration.
TEST(Fibres, PullByTheirActiveStressWhenHeld) {
  const auto model = Strip();
  State state = model->InitialState();
  v1::Parameters parameters = model->parameters;
  const auto pull = [&] {
    Points f = Points::Zero(3, state.x.cols());
    model->forces.front()->AddForce(MakeEvalContext(*model, parameters, state), f);
    double sum = 0;
    for (int i = 0; i < f.cols(); i += 9) sum += f(0, i);
    return sum;
  };
  state.phase = 0.25;
  EXPECT_NEAR(pull(), 100 * 0.01 * 0.2, 1e-12);
  parameters.set_breath_force(3);
  EXPECT_NEAR(pull(), 3 * 100 * 0.01 * 0.2, 1e-12);
  parameters.set_apply_muscles(false);
  EXPECT_NEAR(pull(), 0, 1e-12);
  parameters.set_apply_muscles(true);
  state.phase = 0.75;
  EXPECT_NEAR(pull(), 0, 1e-12);
}

// The harmonic function between two concentric circles is log r: its gradient is radial.
TEST(HarmonicBetween, TwoCirclesIsTheLogarithm) {
  constexpr int kAround = 48, kOut = 12;
  Mesh mesh;
  mesh.vertices.resize(3, kAround * (kOut + 1));
  mesh.triangles.resize(3, 2 * kAround * kOut);
  std::vector<bool> inner(mesh.vertices.cols()), outer(mesh.vertices.cols());
  const auto at = [](int r, int a) { return r * kAround + a % kAround; };
  for (int r = 0; r <= kOut; ++r) {
    for (int a = 0; a < kAround; ++a) {
      const double radius = std::pow(2, static_cast<double>(r) / kOut), angle = 2 * M_PI * a / kAround;
      mesh.vertices.col(at(r, a)) = Eigen::Vector3d(radius * std::cos(angle), radius * std::sin(angle), 0);
      inner[at(r, a)] = r == 0, outer[at(r, a)] = r == kOut;
      if (r == kOut) continue;
      mesh.triangles.col(2 * at(r, a)) = Eigen::Vector3i(at(r, a), at(r + 1, a), at(r, a + 1));
      mesh.triangles.col(2 * at(r, a) + 1) = Eigen::Vector3i(at(r + 1, a), at(r + 1, a + 1), at(r, a + 1));
    }
  }
  const auto value = HarmonicBetween(mesh, inner, outer);
  ASSERT_TRUE(value.ok());
  for (int i = 0; i < mesh.vertices.cols(); ++i) {
    EXPECT_NEAR((*value)[i], std::log2(mesh.vertices.col(i).norm()), 1e-3);
  }
}

}  // namespace
}  // namespace phrenic
