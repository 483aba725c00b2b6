// Benchmarks of NAFEMS: an elliptic membrane (LE1) and the vibrations of a cantilevered plate (FV16). Targets: The
// Standard NAFEMS Benchmarks, rev. 3, 1990.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <cmath>
#include <numbers>

#include "tests/exact/sheets.h"
#include "tests/static_solve.h"

namespace phrenic {
namespace {

// LE1: a quarter of a plate between two ellipses, (x/2)^2 + y^2 = 1 and (x/3.25)^2 + (y/2.75)^2 = 1, 0.1 m thick,
// E = 210 GPa, nu = 0.3, under 10 MPa of tension on the outer one: sigma_yy = 92.7 MPa at D = (2, 0).
constexpr double kTargetStress = 92.7e6, kOuterTension = 10e6, kPlateThickness = 0.1, kSteel = 210e9;

SheetMesh QuarterEllipse(int cells, double disorder) {
  SheetMesh sheet({1, cells}, {std::numbers::pi / 2, 2 * cells}, disorder);
  for (auto point : sheet.mesh.vertices.colwise()) {
    const double s = point.x(), angle = point.y();
    point = Eigen::Vector3d((2 + 1.25 * s) * std::cos(angle), (1 + 1.75 * s) * std::sin(angle), 0);
  }
  return sheet;
}

Points OuterTension(const SheetMesh& sheet) {
  Points load = Points::Zero(3, sheet.mesh.vertices.cols());
  for (int j = 0; j < sheet.v.cells; ++j) {
    const int a = sheet.At(sheet.u.cells, j), b = sheet.At(sheet.u.cells, j + 1);
    const Eigen::Vector3d along = sheet.mesh.vertices.col(b) - sheet.mesh.vertices.col(a);
    const Eigen::Vector3d force = kOuterTension * kPlateThickness * Eigen::Vector3d(along.y(), -along.x(), 0);
    for (const int end : {a, b}) load.col(end) += force / 2;
  }
  return load;
}

// sigma_yy at D = E du_y/dy, as the border is free there and runs along y. u_y is odd in y: the cubic a y + b y^3 of
// least squares through four vertices.
double StressAtD(const SheetMesh& sheet, const Points& rest, const Points& x) {
  Eigen::Matrix<double, 4, 2> terms;
  Eigen::Vector4d values;
  for (int j = 1; j <= 4; ++j) {
    const int a = sheet.At(0, j);
    terms.row(j - 1) << rest(1, a), std::pow(rest(1, a), 3);
    values[j - 1] = x(1, a) - rest(1, a);
  }
  return kSteel * terms.colPivHouseholderQr().solve(values)[0];
}

double ErrorOfLe1(int cells, double disorder) {
  const SheetMesh sheet = QuarterEllipse(cells, disorder);
  const auto model = CompileMesh(sheet.mesh,
                                 "} forces { membrane { bodies: 'body' youngs_modulus: 210e9 poissons_ratio: 0.3 "
                                 "thickness: 0.1 strain: STRAIN_LINEAR } }");
  const auto held = [&](int vertex, int axis) {
    const int row = vertex / (sheet.u.cells + 1);
    return axis == 2 || (axis == 1 && row == 0) || (axis == 0 && row == sheet.v.cells);
  };
  const Points x = SolveStatic(*model, model->rest, OuterTension(sheet), held);
  return StressAtD(sheet, model->rest, x) / kTargetStress - 1;
}

TEST(NafemsLe1, StressOfTheEllipticMembraneConvergesToTheTarget) {
  for (const double disorder : {0.0, 0.2}) {
    const std::vector<double> errors = {ErrorOfLe1(8, disorder), ErrorOfLe1(16, disorder), ErrorOfLe1(32, disorder)};
    ReportErrors(disorder > 0 ? "LE1, irregular" : "LE1, regular", errors);
    EXPECT_LT(std::abs(errors.back()), disorder > 0 ? 0.03 : 0.01);
    for (const double order : OrdersOf(errors)) EXPECT_GT(order, disorder > 0 ? 1 : 1.6);
  }
}

// FV16: a square plate of 10 m, 0.05 m thick, clamped along one side; E = 200 GPa, nu = 0.3, 8000 kg/m^3. The targets
// [Hz] are Barton's of 1951 by Ritz's method, upper bounds: frequencies converge to about
// 1 % below them.
constexpr std::array<double, 6> kTargetFrequencies = {0.421, 1.029, 2.582, 3.306, 3.753, 6.555};

// The lowest eigenvalues of K u = omega^2 M u, by subspace iteration.
Eigen::VectorXd LowestEigenvalues(const Eigen::SparseMatrix<double>& stiffness, const Eigen::VectorXd& mass) {
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(stiffness);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> value(-1, 1);
  Eigen::MatrixXd basis = Eigen::MatrixXd::NullaryExpr(mass.size(), 12, [&] { return value(random); });
  Eigen::VectorXd eigenvalues;
  for (int iteration = 0; iteration < 20; ++iteration) {
    basis = solver.solve(mass.asDiagonal() * basis).eval();
    const Eigen::MatrixXd k = basis.transpose() * stiffness * basis, m = basis.transpose() * mass.asDiagonal() * basis;
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> ritz(k, m);
    basis *= ritz.eigenvectors();
    eigenvalues = ritz.eigenvalues();
  }
  return eigenvalues;
}

// The errors of the six frequencies.
std::array<double, 6> ErrorsOfFv16(int cells, double disorder) {
  SheetMesh sheet({10, cells, 1, 0}, {10, cells}, disorder);
  sheet.ForEach([&](int i, int j) {
    if (i <= 0) sheet.mesh.regions["fixed"].push_back(sheet.At(i, j));
  });
  const auto model =
      CompileMesh(sheet.mesh,
                  "fixed_regions: 'fixed' material { density: 8000 thickness: 0.05 } } forces { bending { bodies: "
                  "'body' youngs_modulus: 200e9 poissons_ratio: 0.3 thickness: 0.05 } }");
  const auto freedoms =
      FreedomsOf(model->rest.cols(), [&](int i, int axis) { return axis < 2 || model->inverse_mass[i] == 0; });
  BlockMatrix stiffness(*model);
  stiffness.Assemble(*model, MakeEvalContext(*model, model->parameters, model->InitialState()));
  const Eigen::VectorXd mass = freedoms * model->mass.replicate(1, 3).transpose().reshaped();
  const Eigen::VectorXd found = LowestEigenvalues(freedoms * stiffness.ToSparse() * freedoms.transpose(), mass);
  std::array<double, 6> errors{};
  for (int mode = 0; mode < 6; ++mode) {
    errors[mode] = std::sqrt(found[mode]) / (2 * std::numbers::pi) / kTargetFrequencies[mode] - 1;
  }
  return errors;
}

// The order is that of the differences between meshes, log2((f1 - f2)/(f2 - f3)).
TEST(NafemsFv16, FrequenciesOfTheCantileveredPlateConvergeToTheTargets) {
  for (const double disorder : {0.0, 0.2}) {
    std::vector<std::array<double, 6>> by_mesh;
    for (const int cells : {8, 16, 32}) by_mesh.push_back(ErrorsOfFv16(cells, disorder));
    for (size_t mode = 0; mode < 6; ++mode) {
      const std::vector<double> errors = {by_mesh[0][mode], by_mesh[1][mode], by_mesh[2][mode]};
      const double order = std::log2((errors[0] - errors[1]) / (errors[1] - errors[2]));
      const std::string what = absl::StrFormat("FV16, mode %d, %s", mode + 1, disorder > 0 ? "irregular" : "regular");
      ReportErrors(what, errors, {order});
      EXPECT_LT(std::abs(errors.back()), 0.025) << what;
      EXPECT_NEAR(order, 2, 0.6) << what;
      EXPECT_NEAR(errors[2] + (errors[2] - errors[1]) / 3, -0.006, 0.01) << what << ", extrapolated";
    }
  }
}

}  // namespace
}  // namespace phrenic
