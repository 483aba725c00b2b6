// Compares bending with the theory of thin plates where its solutions are quadratic or the sheet is rolled up.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/compile_text.h"
#include "tests/exact/sheets.h"
#include "tests/static_solve.h"

namespace phrenic {
namespace {

double EnergyOf(const Model& model, const State& state) {
  double energy = 0;
  for (const auto& force : model.forces) energy += force->Energy(MakeEvalContext(model, model.parameters, state));
  return energy;
}

// E h^3 / 12 = 1 N m: the flexural rigidity is 1/(1 - nu^2).
std::string Plate(double poissons_ratio, const std::string& more = "") {
  return absl::StrFormat(
      "} forces { bending { bodies: 'body' youngs_modulus: 12e3 thickness: 0.1 poissons_ratio: %g %s } }",
      poissons_ratio, more);
}

// The relative error of the energy of a sheet of 1 m x 0.7 m that is rolled up on a cylinder by 250 degrees, without
// the border, where the sheet is free and does not keep the cylinder's curvature.
double ErrorWhenRolled(int cells) {
  const SheetMesh sheet({1.2, cells, 2, 2}, {0.7, cells / 2, 2, 2}, 0.2);
  const auto model = CompileMesh(sheet.mesh, Plate(0.25, "region: 'inside'"));
  const double curvature = 250 / 57.295779513 / 1.2;
  State state = model->InitialState();
  for (int i = 0; i < state.x.cols(); ++i) {
    const double angle = curvature * model->rest(0, i);
    state.x(0, i) = std::sin(angle) / curvature;
    state.x(2, i) = (1 - std::cos(angle)) / curvature;
  }
  return EnergyOf(*model, state) / (curvature * curvature / 2 / (1 - 0.25 * 0.25) * 1.2 * 0.7) - 1;
}

TEST(Bending, OfASheetRolledOnACylinderHasTheEnergyOfItsFlexuralRigidity) {
  const std::vector<double> errors = {ErrorWhenRolled(12), ErrorWhenRolled(24), ErrorWhenRolled(48)};
  ReportErrors("rolled sheet", errors);
  EXPECT_LT(std::abs(errors.back()), 0.01);
  for (const double order : OrdersOf(errors)) EXPECT_GT(order, 1.7);
}

// The largest error of an irregular plate with free borders that is held at `given` where held(i, j), relative to the
// largest deflection.
double ErrorOfPatch(double poissons_ratio, const std::function<double(double x, double y)>& given,
                    const std::function<bool(const SheetMesh&, int i, int j)>& held) {
  const SheetMesh sheet({1, 12}, {0.6, 6}, 0.2);
  const auto model = CompileMesh(sheet.mesh, Plate(poissons_ratio));
  constexpr double kSmall = 1e-5;  // so that linear theory holds
  Points exact = model->rest, start = model->rest;
  std::vector<bool> kept(static_cast<size_t>(exact.cols()), false);
  sheet.ForEach([&](int i, int j) {
    const int a = sheet.At(i, j);
    exact(2, a) = kSmall * given(exact(0, a), exact(1, a));
    kept[a] = held(sheet, i, j);
    if (kept[a]) start(2, a) = exact(2, a);
  });
  const Points x =
      SolveStatic(*model, start, Points::Zero(3, exact.cols()), [&](int i, int axis) { return axis < 2 || kept[i]; });
  return (x - exact).cwiseAbs().maxCoeff() / exact.row(2).cwiseAbs().maxCoeff();
}

// Bent in one direction, a plate with free sides curves the other way by Poisson's ratio.
TEST(Bending, OfAStripHasAnticlasticCurvature) {
  for (const double nu : {0.0, 0.3, 0.5}) {
    const auto saddle = [nu](double x, double y) { return x * x - nu * y * y; };
    const auto ends = [](const SheetMesh& sheet, int i, int) { return i < 4 || i > sheet.u.cells - 4; };
    EXPECT_LT(ErrorOfPatch(nu, saddle, ends), 1e-6) << "nu = " << nu;
    const auto cylinder = [](double x, double) { return x * x; };
    if (nu > 0) {
      EXPECT_GT(ErrorOfPatch(nu, cylinder, ends), 1e-3);
    }
  }
}

// A plate that four forces at its corners twist is a hyperbolic paraboloid, which has no other force on its border.
TEST(Bending, OfAPlateTwistedAtItsCornersIsAHyperbolicParaboloid) {
  const auto corners = [](const SheetMesh& sheet, int i, int j) {
    return (i == 0 || i == sheet.u.cells) && (j == 0 || j == sheet.v.cells);
  };
  EXPECT_LT(ErrorOfPatch(
                0.3, [](double x, double y) { return x * y; }, corners),
            1e-6);
}

TEST(Bending, OfACurvedShapeIsZeroAtRest) {
  const auto model = CompileText(
      "name: 'dome' bodies { name: 'dome' role: ROLE_DEFORMABLE ellipsoid { radii { x: 0.1 y: 0.08 z: 0.06 } "
      "upper_half: true } } forces { bending { bodies: 'dome' youngs_modulus: 2e6 thickness: 0.01 } }");
  State state = model->InitialState();
  EXPECT_LT(ForceOn(*model, state).cwiseAbs().maxCoeff(), 1e-9);
  state.x.row(2) *= 0.5;
  EXPECT_GT(EnergyOf(*model, state), 1e-3);
}

}  // namespace
}  // namespace phrenic
