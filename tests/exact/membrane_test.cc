// Compares membrane finite elements with linear elasticity.
#include <gtest/gtest.h>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "tests/compile_text.h"
#include "tests/static_solve.h"

namespace phrenic {
namespace {

std::string Material(const std::string& strain, double youngs_modulus = 1000, double thickness = 0.01) {
  return absl::StrFormat(
      "forces { membrane { bodies: 'sheet' youngs_modulus: %g poissons_ratio: 0.3333333333333333 thickness: %g "
      "strain: %s } }",
      youngs_modulus, thickness, strain);
}

std::string Sheet(const std::string& strain) {
  return "name: 'patch' bodies { name: 'sheet' role: ROLE_DEFORMABLE grid { columns: 5 rows: 4 u { x: 0.1 y: 0.01 } v "
         "{ y: 0.12 x: 0.03 } } } " +
         Material(strain);
}

class MembraneStrain : public testing::TestWithParam<const char*> {};

// Patch test: with boundary displacements of a uniform strain, a patch of arbitrary triangles has that strain
// everywhere.
TEST_P(MembraneStrain, PassesThePatchTest) {
  const auto model = CompileText(Sheet(GetParam()));
  Eigen::Matrix3d stretch = Eigen::Matrix3d::Identity();
  stretch.topLeftCorner<2, 2>() << 1.02, 0.013, -0.007, 0.99;
  const Points exact = stretch * model->rest;
  Points start = exact;
  const auto inner = [](int i) { return i % 5 > 0 && i % 5 < 4 && i / 5 > 0 && i / 5 < 3; };
  for (int i = 0; i < start.cols(); ++i) {
    if (inner(i)) start.col(i) = model->rest.col(i) + Eigen::Vector3d(0.01, -0.02, 0) * (i % 2);
  }
  const Points none = Points::Zero(3, start.cols());
  const Points x = SolveStatic(*model, start, none, [&](int i, int axis) { return !inner(i) || axis == 2; });
  EXPECT_LT((x - exact).cwiseAbs().maxCoeff(), 1e-12);
}

// A strip of width w under the axial strain e, free across, has the force E h w e.
TEST_P(MembraneStrain, StretchesByYoungsModulusAndThinsByPoissonsRatio) {
  const auto model = CompileText(Sheet(GetParam()));
  constexpr double kStrain = 1e-6;
  State state = model->InitialState();
  state.x.row(0) *= 1 + kStrain;
  state.x.row(1) *= 1 - kStrain / 3;
  const double volume = 4 * 3 * (0.1 * 0.12 - 0.01 * 0.03) * 0.01;
  double energy = 0;
  for (const auto& force : model->forces) energy += force->Energy(MakeEvalContext(*model, model->parameters, state));
  EXPECT_NEAR(energy, 0.5 * 1000 * kStrain * kStrain * volume, 1e-5 * energy);
}

INSTANTIATE_TEST_SUITE_P(Strains, MembraneStrain, testing::Values("STRAIN_LINEAR", "STRAIN_COROTATIONAL"));

double LargestForceWhenTurned(const std::string& strain) {
  const auto model = CompileText(Sheet(strain));
  State state = model->InitialState();
  state.x = Eigen::AngleAxisd(1.2, Eigen::Vector3d(1, -2, 3).normalized()).toRotationMatrix() * model->rest;
  return ForceOn(*model, state).cwiseAbs().maxCoeff();
}

TEST(MembraneTurned, PullsOnlyWhereStrainIsLinear) {
  EXPECT_LT(LargestForceWhenTurned("STRAIN_COROTATIONAL"), 1e-13);
  EXPECT_GT(LargestForceWhenTurned("STRAIN_LINEAR"), 0.1);
}

// Cook's membrane: clamped on the left (44 high), sheared by 1 on the right (16 high), 48 wide; E = 1, h = 1, nu = 1/3.
std::string CooksMembrane(int cells) {
  std::string text = "name: 'cook' bodies { name: 'sheet' role: ROLE_DEFORMABLE polyhedron {";
  for (int r = 0; r <= cells; ++r) {
    for (int c = 0; c <= cells; ++c) {
      const double s = static_cast<double>(c) / cells, t = static_cast<double>(r) / cells;
      absl::StrAppend(&text, absl::StrFormat(" vertices { x: %.17g y: %.17g }", 48 * s, 44 * s + t * (44 - 28 * s)));
    }
  }
  for (int r = 0; r < cells; ++r) {
    for (int c = 0; c < cells; ++c) {
      const int i = r * (cells + 1) + c, up = i + cells + 1;
      absl::StrAppend(&text, absl::StrFormat(" triangles { a: %d b: %d c: %d }", i, i + 1, up));
      absl::StrAppend(&text, absl::StrFormat(" triangles { a: %d b: %d c: %d }", i + 1, up + 1, up));
    }
  }
  return text + " } } " + Material("STRAIN_LINEAR", 1, 1);
}

double MidEdgeOfCook(int cells) {
  const auto model = CompileText(CooksMembrane(cells));
  Points load = Points::Zero(3, model->rest.cols());
  for (int r = 0; r < cells; ++r) {
    for (const int row : {r, r + 1}) load(1, row * (cells + 1) + cells) += 0.5 / cells;
  }
  const Points x =
      SolveStatic(*model, model->rest, load, [&](int i, int axis) { return i % (cells + 1) == 0 || axis == 2; });
  const int middle = cells / 2 * (cells + 1) + cells;
  return x(1, middle) - model->rest(1, middle);
}

TEST(CooksMembrane, ConvergesFromBelow) {
  const double coarse = MidEdgeOfCook(8), middle = MidEdgeOfCook(16), fine = MidEdgeOfCook(32);
  EXPECT_LT(coarse, middle);
  EXPECT_LT(middle, fine);
  EXPECT_LT(fine, 23.96);
  EXPECT_NEAR(fine, 23.96, 0.01 * 23.96);
  EXPECT_NEAR(fine + (fine - middle) / 3, 23.96, 0.005 * 23.96);  // Richardson extrapolation at second order
}

}  // namespace
}  // namespace phrenic
