// Compares solid finite elements with linear elasticity.
#include <gtest/gtest.h>

#include "absl/strings/str_format.h"
#include "tests/compile_text.h"
#include "tests/static_solve.h"

namespace phrenic {
namespace {

// A beam of 1 x 0.2 x 0.2 m with Young's modulus 1000 Pa, n cells across and 5 n along.
std::shared_ptr<const Model> Beam(int n, const std::string& strain) {
  return CompileText(
      absl::StrFormat("name: 'beam' bodies { name: 'beam' role: ROLE_DEFORMABLE block { size { x: 1 y: 0.2 z: 0.2 } "
                      "columns: %d rows: %d layers: %d } material { density: 1000 } } forces { solid { bodies: 'beam' "
                      "youngs_modulus: 1000 poissons_ratio: 0.3 strain: %s } }",
                      5 * n, n, n, strain));
}

// A traction [Pa] on the face x = 1.
Points PullOnTheEnd(const Model& model, const Eigen::Vector3d& traction) {
  const Mesh& mesh = model.bodies[0].mesh;
  Points load = Points::Zero(3, mesh.vertices.cols());
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    const Eigen::Vector3i corner = mesh.triangles.col(t);
    const auto x = [&](int k) { return Eigen::Vector3d(mesh.vertices.col(corner[k])); };
    if (std::min({x(0).x(), x(1).x(), x(2).x()}) < 1 - 1e-9) continue;
    const double area = (x(1) - x(0)).cross(x(2) - x(0)).norm() / 2;
    for (int k = 0; k < 3; ++k) load.col(corner[k]) += area / 3 * traction;
  }
  return load;
}

class SolidStrain : public testing::TestWithParam<const char*> {};

TEST_P(SolidStrain, PassesThePatchTest) {
  const auto model = Beam(3, GetParam());
  Eigen::Matrix3d stretch;
  stretch << 1.02, 0.013, 0.004, -0.007, 0.99, 0.011, 0.003, -0.002, 1.01;
  const Points exact = stretch * model->rest;
  const Mesh& mesh = model->bodies[0].mesh;
  std::vector<bool> outer(static_cast<size_t>(mesh.vertices.cols()), false);
  for (const int i : mesh.triangles.reshaped()) outer[i] = true;
  Points start = exact;
  for (int i = 0; i < start.cols(); ++i) {
    if (!outer[i]) start.col(i) = model->rest.col(i) + Eigen::Vector3d(0.01, -0.02, 0.01) * (i % 2);
  }
  const Points x = SolveStatic(*model, start, Points::Zero(3, start.cols()), [&](int i, int) { return outer[i]; });
  EXPECT_LT((x - exact).cwiseAbs().maxCoeff(), 1e-12);
}

// Under an axial traction p, a free beam lengthens by p L / E and has the transverse strain -nu p / E.
TEST_P(SolidStrain, StretchesByYoungsModulusAndThinsByPoissonsRatio) {
  const auto model = Beam(2, GetParam());
  const auto on_plane = [&](int i, int axis) { return model->rest(axis, i) == 0; };
  constexpr double kTraction = 1e-5;  // [Pa]; small, so that linear theory holds
  const Points x = SolveStatic(*model, model->rest, PullOnTheEnd(*model, {kTraction, 0, 0}), on_plane);
  const double strain = kTraction / 1000;
  const Points exact = Eigen::Vector3d(1 + strain, 1 - 0.3 * strain, 1 - 0.3 * strain).asDiagonal() * model->rest;
  EXPECT_LT((x - exact).cwiseAbs().maxCoeff(), 1e-6 * strain);
}

INSTANTIATE_TEST_SUITE_P(Strains, SolidStrain, testing::Values("STRAIN_LINEAR", "STRAIN_COROTATIONAL"));

double LargestForceOfATurnedCube(const std::string& strain) {
  const auto model = Beam(2, strain);
  State state = model->InitialState();
  state.x = Eigen::AngleAxisd(1.2, Eigen::Vector3d(1, -2, 3).normalized()).toRotationMatrix() * model->rest;
  return ForceOn(*model, state).cwiseAbs().maxCoeff();
}

TEST(SolidTurned, PullsOnlyWhereStrainIsLinear) {
  EXPECT_LT(LargestForceOfATurnedCube("STRAIN_COROTATIONAL"), 1e-13);
  EXPECT_GT(LargestForceOfATurnedCube("STRAIN_LINEAR"), 0.1);
}

double SagOfCantilever(int n) {
  const auto model = Beam(n, "STRAIN_LINEAR");
  const Points x = SolveStatic(*model, model->rest, PullOnTheEnd(*model, {0, 0, -0.01}),
                               [&](int i, int) { return model->rest(0, i) == 0; });
  return -(x - model->rest).row(2).minCoeff();
}

// Deflection of Timoshenko's beam: F L^3 / (3 E I) + F L / (5/6 G A). Constant-strain elements are too stiff in
// bending; the error falls at second order, except at the clamped corners.
TEST(Cantilever, ConvergesFromBelow) {
  const double side = 0.2, force = 0.01 * side * side, shear = 1000 / 2.6;
  const double exact = force / (3 * 1000 * std::pow(side, 4) / 12) + force / (5.0 / 6 * shear * side * side);
  const double coarse = SagOfCantilever(3), fine = SagOfCantilever(6);
  EXPECT_LT(coarse, fine);
  EXPECT_LT(fine, exact);
  EXPECT_LT(exact - fine, 0.4 * (exact - coarse));
  EXPECT_NEAR(fine + (fine - coarse) / 3, exact, 0.05 * exact);
}

}  // namespace
}  // namespace phrenic
