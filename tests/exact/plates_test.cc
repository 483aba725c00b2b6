// Compares bending with published and manufactured solutions of thin plates on regular and irregular meshes:
// deflections converge at second order.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/exact/sheets.h"
#include "tests/static_solve.h"

namespace phrenic {
namespace {

constexpr double kDeflection = 1e-5;  // about the largest [m], so that linear theory holds on sheets of 1 m

// D = 1 N m.
std::string UnitPlate(double poissons_ratio) {
  return absl::StrFormat(
      "fixed_regions: 'fixed' } forces { bending { bodies: 'body' youngs_modulus: %.17g thickness: 0.1 "
      "poissons_ratio: %g } }",
      12e3 * (1 - poissons_ratio * poissons_ratio), poissons_ratio);
}

// The deflections under a load [N], along z.
Eigen::RowVectorXd Deflect(const SheetMesh& sheet, double poissons_ratio, const Points& load) {
  const auto model = CompileMesh(sheet.mesh, UnitPlate(poissons_ratio));
  const auto held = [&](int i, int axis) { return axis < 2 || model->inverse_mass[i] == 0; };
  return SolveStatic(*model, model->rest, load, held).row(2);
}

// A square of 1 m: supported at its border, or clamped as a row of held triangles continues it.
SheetMesh SquareSheet(int cells, double disorder, bool clamped) {
  const int beyond = clamped ? 1 : 0;
  SheetMesh sheet({1, cells, beyond, beyond}, {1, cells, beyond, beyond}, disorder);
  sheet.ForEach([&](int i, int j) {
    if (!sheet.Inside(i, j) || sheet.OnBorder(i, j)) sheet.mesh.regions["fixed"].push_back(sheet.At(i, j));
  });
  return sheet;
}

// Deflection of the middle under a uniform load q: 0.00126532 q a^4/D clamped, 0.00406235 q a^4/D supported (Timoshenko
// and Woinowsky-Krieger 1959, tables 35 and 8), whatever Poisson's ratio is. Returns the relative error.
double ErrorOfSquare(int cells, double disorder, bool clamped, double poissons_ratio) {
  const double exact = clamped ? 0.00126532 : 0.00406235, q = kDeflection / exact;
  const SheetMesh sheet = SquareSheet(cells, disorder, clamped);
  const Points load = AreaLoad(sheet, 2, [q](const Eigen::Vector3d&) { return q; });
  return Deflect(sheet, poissons_ratio, load)[sheet.At(cells / 2, cells / 2)] / kDeflection - 1;
}

std::vector<double> ErrorsOfSquare(double disorder, bool clamped) {
  std::vector<double> errors;
  for (const int cells : {16, 32, 64}) errors.push_back(ErrorOfSquare(cells, disorder, clamped, 0.3));
  return errors;
}

TEST(SquarePlate, ClampedConvergesToTheSeries) {
#ifdef PHRENIC_SANITIZED
  GTEST_SKIP() << "the Release build runs it; the supported plate takes the same way";
#endif
  for (const double disorder : {0.0, 0.2}) {
    const auto errors = ErrorsOfSquare(disorder, true);
    ReportErrors(disorder > 0 ? "clamped, irregular" : "clamped, regular", errors);
    EXPECT_LT(std::abs(errors.back()), 0.005);
    for (const double order : OrdersOf(errors)) EXPECT_NEAR(order, 2, 0.35);
  }
}

TEST(SquarePlate, SupportedConvergesToTheSeries) {
  for (const double disorder : {0.0, 0.2}) {
    const auto errors = ErrorsOfSquare(disorder, false);
    ReportErrors(disorder > 0 ? "supported, irregular" : "supported, regular", errors);
    EXPECT_LT(std::abs(errors.back()), 0.003);
    EXPECT_NEAR(std::log2(errors.front() / errors.back()) / 2, 2, 0.6);
  }
}

// With straight borders held, Poisson's ratio enters through D alone.
TEST(SquarePlate, DeflectsByPoissonsRatioThroughTheRigidityAlone) {
  const double zero = ErrorOfSquare(32, 0.2, true, 0), half = ErrorOfSquare(32, 0.2, true, 0.5);
  EXPECT_NE(zero, half);
  EXPECT_NEAR(zero, half, 0.005);
}

// The relative error in L2 of a clamped plate under the load of w = (sin pi x sin pi y)^2.
double ErrorOfManufactured(int cells) {
  const double pi = std::numbers::pi;
  const SheetMesh sheet = SquareSheet(cells, 0.2, true);
  const auto load = [pi](const Eigen::Vector3d& x) {  // the biharmonic of w
    const double a = std::cos(2 * pi * x.x()), b = std::cos(2 * pi * x.y());
    return kDeflection * 4 * std::pow(pi, 4) * (4 * a * b - a - b);
  };
  const Eigen::RowVectorXd w = Deflect(sheet, 0.3, AreaLoad(sheet, 2, load));
  const Points area = AreaLoad(sheet, 2, [](const Eigen::Vector3d&) { return 1; });
  double square = 0, norm = 0;
  sheet.ForEach([&](int i, int j) {
    const int a = sheet.At(i, j);
    const double x = sheet.mesh.vertices(0, a), y = sheet.mesh.vertices(1, a);
    const double exact = kDeflection * std::pow(std::sin(pi * x) * std::sin(pi * y), 2);
    square += area(2, a) * std::pow(w[a] - exact, 2);
    norm += area(2, a) * exact * exact;
  });
  return std::sqrt(square / norm);
}

TEST(ManufacturedPlate, ConvergesAtSecondOrder) {
  const std::vector<double> errors = {ErrorOfManufactured(16), ErrorOfManufactured(32), ErrorOfManufactured(64)};
  ReportErrors("manufactured plate", errors);
  for (const double order : OrdersOf(errors)) EXPECT_NEAR(order, 2, 0.3);
  EXPECT_LT(errors.back(), 0.01);
}

// A strip of 1 x 0.2 m, clamped at x = 0, with a force on its end, without Poisson's effect: F L^3 / (3 D width).
std::vector<double> ErrorsOfCantilever(double disorder) {
  std::vector<double> errors;
  for (const int cells : {10, 20, 40}) {
    SheetMesh sheet({1, cells, 1, 0}, {0.2, cells / 5}, disorder);
    sheet.ForEach([&](int i, int j) {
      if (i <= 0) sheet.mesh.regions["fixed"].push_back(sheet.At(i, j));
    });
    Points load = Points::Zero(3, sheet.mesh.vertices.cols());
    const double force = kDeflection * 3 * 0.2;
    for (int j = 0; j < sheet.v.cells; ++j) {
      const int a = sheet.At(cells, j), b = sheet.At(cells, j + 1);
      const double part = (sheet.mesh.vertices(1, b) - sheet.mesh.vertices(1, a)) / 0.2;
      for (const int end : {a, b}) load(2, end) += part * force / 2;
    }
    errors.push_back(Deflect(sheet, 0, load).dot(load.row(2)) / force / kDeflection - 1);
  }
  return errors;
}

TEST(CantileverPlate, ConvergesToTheBeam) {
  for (const double disorder : {0.0, 0.2}) {
    const auto errors = ErrorsOfCantilever(disorder);
    ReportErrors(disorder > 0 ? "cantilever, irregular" : "cantilever, regular", errors);
    EXPECT_LT(std::abs(errors.back()), 0.001);
    for (const double order : OrdersOf(errors)) EXPECT_GT(order, 1.5);
  }
}

}  // namespace
}  // namespace phrenic
