#include "server/mechanics/spectrum.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "tests/compile_text.h"

namespace phrenic {
namespace {

// Two of the cube's vertices move by forces: six unknowns, which Lanczos uses up, and round-off is left.
std::shared_ptr<const Model> Cube() {
  std::ifstream file(PHRENIC_SOURCE_DIR "/server/scenes/cube-tensegrity.textproto");
  std::stringstream text;
  text << file.rdbuf();
  return CompileText(text.str());
}

TEST(Spectrum, GrowsWithTheRootOfStiffnessWhereAllUnknownsAreUsedUp) {
  const auto model = Cube();
  v1::Parameters parameters = model->parameters;
  parameters.set_elasticity(1);
  const double soft = FindFastestMode(*model, parameters, model->InitialState()).spectrum.omega_max;
  EXPECT_GT(soft, 1);
  for (double factor = 10; factor <= 1e6; factor *= 10) {
    parameters.set_elasticity(factor);
    const double stiff = FindFastestMode(*model, parameters, model->InitialState()).spectrum.omega_max;
    EXPECT_NEAR(stiff, std::sqrt(factor) * soft, 1e-6 * stiff) << factor;
  }
}

}  // namespace
}  // namespace phrenic
