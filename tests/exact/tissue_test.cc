// One tissue with several methods and mesh sizes: results for a given material must not depend on the mesh.
#include <gtest/gtest.h>

#include "absl/strings/str_format.h"
#include "tests/compile_text.h"
#include "tests/static_solve.h"

namespace phrenic {
namespace {

std::string Membrane(const std::string& where) {
  return "forces { membrane { bodies: 'sheet' youngs_modulus: 20000 poissons_ratio: 0.3333333333333333 thickness: "
         "0.003 " +
         where + " } } ";
}

std::string Springs(const std::string& where) {
  return "forces { springs { bodies: 'sheet' material { youngs_modulus: 20000 thickness: 0.003 } " + where + " } } ";
}

std::string Methods(const std::string& method) {
  if (method == "membrane") return Membrane("");
  if (method == "springs") return Springs("");
  return Membrane("region: 'half'") + Springs("exclude_region: 'half'");
}

// A sheet of 0.2 m along z by 0.1 m, fixed along its upper edge.
std::shared_ptr<const Model> Strip(const std::string& methods, int cells, const std::string& more) {
  const double cell = 0.1 / cells;
  return CompileText(
      absl::StrFormat("name: 'strip' bodies { name: 'sheet' role: ROLE_DEFORMABLE grid { columns: %d rows: %d u { x: "
                      "%.17g } v { z: %.17g } } material { density: 1000 thickness: 0.003 } regions { name: 'top' low "
                      "{} high { x: 1 } } regions { name: 'half' low { z: -0.1 } high { x: 1 } } fixed_regions: 'top' "
                      "} %s %s",
                      cells + 1, 2 * cells + 1, cell, -cell, methods, more));
}

// Mean descent of the lower edge [m], with motion out of the sheet's plane fixed.
double Descent(const Model& model, int cells, double pull) {
  Points load = Points::Zero(3, model.rest.cols());
  for (int c = 0; c <= cells; ++c) load(2, model.rest.cols() - 1 - c) -= pull / cells * (c % cells == 0 ? 0.5 : 1);
  const Points x =
      SolveStatic(model, model.rest, load, [&](int i, int axis) { return axis == 1 || model.inverse_mass[i] == 0; });
  return (model.rest - x).row(2).tail(cells + 1).mean();
}

class Tissue : public testing::TestWithParam<const char*> {};

TEST_P(Tissue, StretchedStripDoesNotDependOnTheMesh) {
  const double pull = 0.02 * 20000 * 0.003 * 0.1;  // a strain of 2 %, except at the clamped edge
  for (const int cells : {4, 8, 16}) {
    EXPECT_NEAR(Descent(*Strip(Methods(GetParam()), cells, ""), cells, pull), 0.02 * 0.2, 0.05 * 0.02 * 0.2) << cells;
  }
}

// Under its own weight a sheet of length L lengthens by density g L^2 / (2 E), for small strains.
TEST_P(Tissue, HangingSheetDoesNotDependOnTheMesh) {
  const double exact = 1000 * 2.0 * 0.2 * 0.2 / (2 * 20000);
  for (const int cells : {4, 8, 16}) {
    const auto model =
        Strip(Methods(GetParam()), cells, "forces { gravity { bodies: 'sheet' acceleration { z: -2 } } }");
    EXPECT_NEAR(model->mass.sum(), 1000 * 0.003 * 0.1 * 0.2, 1e-12);
    EXPECT_NEAR(Descent(*model, cells, 0), exact, 0.05 * exact) << cells;
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, Tissue, testing::Values("membrane", "springs", "mixed"));

// A method with a region and the same method for the rest cover each triangle exactly once.
TEST(PartitionedTissue, HasNeitherGapNorOverlap) {
  for (const auto method : {&Membrane, &Springs}) {
    const auto model = Strip(method("") + method("region: 'half'") + method("exclude_region: 'half'"), 8, "");
    State state = model->InitialState();
    for (double& value : state.x.reshaped()) value += 0.002 * std::sin(1e4 * value);
    std::vector<double> energy;
    for (const auto& force : model->forces) {
      energy.push_back(force->Energy(MakeEvalContext(*model, model->parameters, state)));
    }
    ASSERT_EQ(energy.size(), 3u);
    EXPECT_NEAR(energy[1] + energy[2], energy[0], 1e-12 * energy[0]);
  }
}

}  // namespace
}  // namespace phrenic
