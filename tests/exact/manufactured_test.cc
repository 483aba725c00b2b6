// The method of manufactured solutions: a displacement is chosen, linear elasticity gives the body force that it needs,
// and the solid element finds it again on irregular meshes, at second order in L2.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "tests/compile_text.h"
#include "tests/exact/sheets.h"
#include "tests/static_solve.h"

namespace phrenic {
namespace {

constexpr double kYoungsModulus = 1000, kPoissonsRatio = 0.3;
constexpr double kMu = kYoungsModulus / (2 * (1 + kPoissonsRatio));
constexpr double kLambda = kYoungsModulus * kPoissonsRatio / ((1 + kPoissonsRatio) * (1 - 2 * kPoissonsRatio));

// u = (sin px sin py, sin py sin pz, sin pz sin px), p = pi [m].
Eigen::Vector3d Chosen(const Eigen::Vector3d& x) {
  const Eigen::Vector3d s = (std::numbers::pi * x).array().sin();
  return {s[0] * s[1], s[1] * s[2], s[2] * s[0]};
}

// f = -mu Laplacian(u) - (lambda + mu) grad div u [N/m^3].
Eigen::Vector3d BodyForceOf(const Eigen::Vector3d& x) {
  const double square = std::numbers::pi * std::numbers::pi;
  const Eigen::Vector3d c = (std::numbers::pi * x).array().cos(), u = Chosen(x);
  const Eigen::Vector3d gradient_of_divergence = square * (Eigen::Vector3d(c[2] * c[0], c[0] * c[1], c[1] * c[2]) - u);
  return 2 * kMu * square * u - (kLambda + kMu) * gradient_of_divergence;
}

// A unit cube of n^3 cells whose inner vertices are moved at random by up to 0.15 cells.
Mesh IrregularCube(int n) {
  const auto regular = CompileText(absl::StrFormat(
      "name: 'cube' bodies { name: 'cube' role: ROLE_DEFORMABLE block { size { x: 1 y: 1 z: 1 } columns: %d rows: %d "
      "layers: %d } } forces { gravity { bodies: 'cube' acceleration { z: -1 } } }",
      n, n, n));
  Mesh mesh = regular->bodies[0].mesh;
  std::vector<bool> outer(static_cast<size_t>(mesh.vertices.cols()), false);
  for (const int i : mesh.triangles.reshaped()) outer[i] = true;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> shift(-0.15, 0.15);
  for (int i = 0; i < mesh.vertices.cols(); ++i) {
    for (double& value : mesh.vertices.col(i)) value += outer[i] ? 0 : shift(random) / n;
  }
  return mesh;
}

// Calls `use(weight, barycentric)` at the four points of a rule that is exact for quadratics.
template <typename Use>
void ForEachPoint(double volume, const Use& use) {
  const double apart = 1 / std::sqrt(5.0);
  for (int p = 0; p < 4; ++p) {
    Eigen::Vector4d barycentric = Eigen::Vector4d::Constant((1 - apart) / 4);
    barycentric[p] += apart;
    use(volume / 4, barycentric);
  }
}

template <typename Use>
void ForEachTetrahedron(const Mesh& mesh, const Use& use) {
  for (const auto corner : mesh.tetrahedra.colwise()) {
    Eigen::Matrix<double, 3, 4> x;
    for (int k = 0; k < 4; ++k) x.col(k) = mesh.vertices.col(corner[k]);
    const double volume = (x.col(1) - x.col(0)).cross(x.col(2) - x.col(0)).dot(x.col(3) - x.col(0)) / 6;
    use(Eigen::Vector4i(corner), x, volume);
  }
}

Points BodyLoad(const Mesh& mesh, double scale) {
  Points load = Points::Zero(3, mesh.vertices.cols());
  ForEachTetrahedron(mesh, [&](const Eigen::Vector4i& corner, const auto& x, double volume) {
    ForEachPoint(volume, [&](double weight, const Eigen::Vector4d& at) {
      for (int k = 0; k < 4; ++k) load.col(corner[k]) += scale * weight * at[k] * BodyForceOf(x * at);
    });
  });
  return load;
}

// The error of the displacement in L2, relative.
double ErrorOfChosen(int n, const std::string& strain) {
  const Mesh mesh = IrregularCube(n);
  const auto model = CompileMesh(
      mesh,
      "material { density: 1000 } } forces { solid { bodies: 'body' youngs_modulus: 1000 poissons_ratio: 0.3 "
      "strain: " +
          strain + " } }");
  constexpr double kSmall = 1e-7;  // so that the turning elements agree with linear theory
  std::vector<bool> outer(static_cast<size_t>(mesh.vertices.cols()), false);
  for (const int i : mesh.triangles.reshaped()) outer[i] = true;
  Points start = model->rest;
  for (int i = 0; i < start.cols(); ++i) {
    if (outer[i]) start.col(i) += kSmall * Chosen(model->rest.col(i));
  }
  const Points x = SolveStatic(*model, start, BodyLoad(mesh, kSmall), [&](int i, int) { return outer[i]; });
  double square = 0, norm = 0;
  ForEachTetrahedron(mesh, [&](const Eigen::Vector4i& corner, const auto& rest, double volume) {
    Eigen::Matrix<double, 3, 4> u;
    for (int k = 0; k < 4; ++k) u.col(k) = (x.col(corner[k]) - rest.col(k)) / kSmall;
    ForEachPoint(volume, [&](double weight, const Eigen::Vector4d& at) {
      square += weight * (u * at - Chosen(rest * at)).squaredNorm();
      norm += weight * Chosen(rest * at).squaredNorm();
    });
  });
  return std::sqrt(square / norm);
}

class ManufacturedSolid : public testing::TestWithParam<const char*> {};

TEST_P(ManufacturedSolid, ConvergesAtSecondOrder) {
  const std::vector<double> errors = {ErrorOfChosen(4, GetParam()), ErrorOfChosen(8, GetParam()),
                                      ErrorOfChosen(16, GetParam())};
  ReportErrors(std::string("manufactured solid, ") + GetParam(), errors);
  EXPECT_LT(errors.back(), 0.03);
  for (const double order : OrdersOf(errors)) EXPECT_NEAR(order, 2, 0.3);
}

INSTANTIATE_TEST_SUITE_P(Strains, ManufacturedSolid, testing::Values("STRAIN_LINEAR", "STRAIN_COROTATIONAL"));

}  // namespace
}  // namespace phrenic
