// Compares bending with plate theory.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/compile_text.h"
#include "tests/static_solve.h"

namespace phrenic {
namespace {

double EnergyOf(const Model& model, const State& state) {
  double energy = 0;
  for (const auto& force : model.forces) energy += force->Energy(MakeEvalContext(model, model.parameters, state));
  return energy;
}

// A plate of curvature c has the energy B c^2 / 2 per area, except on the outer half cells, where no edge bends.
TEST(Bending, OfARolledPlateHasTheEnergyOfItsFlexuralRigidity) {
  const auto model = CompileText(
      "name: 'plate' bodies { name: 'plate' role: ROLE_DEFORMABLE grid { columns: 9 rows: 4 u { x: 0.1 } v { y: 0.07 } "
      "} } forces { bending { bodies: 'plate' youngs_modulus: 2e6 poissons_ratio: 0.25 thickness: 0.01 } }");
  constexpr double kCurvature = 1.5;
  State state = model->InitialState();
  for (int i = 0; i < state.x.cols(); ++i) {
    const double angle = kCurvature * model->rest(0, i);
    state.x(0, i) = std::sin(angle) / kCurvature;
    state.x(2, i) = (1 - std::cos(angle)) / kCurvature;
  }
  const double rigidity = 2e6 * 1e-6 / (12 * (1 - 0.25 * 0.25)), area = 7 * 3 * 0.1 * 0.07;
  EXPECT_NEAR(EnergyOf(*model, state), rigidity * kCurvature * kCurvature / 2 * area, 1e-12);
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
