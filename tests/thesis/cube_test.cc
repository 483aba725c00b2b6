// The result of figure 5.3 of the thesis as an inequality: the cube of springs collapses, the tensegrity cube keeps its
// height.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/compile_text.h"
#include "tests/thesis/shipped.h"

namespace phrenic {
namespace {

// Lowest height of mass p over three periods of the drive [m].
double LowestHeightOfP(const std::string& scene) {
  const auto model = CompileText(ShippedScene(scene));
  State state = model->InitialState();
  Workspace work = model->MakeWorkspace();
  const double dt = model->parameters.time_step();
  double lowest = 10;
  while (state.time < 12) {
    EXPECT_TRUE(Step(*model, model->parameters, dt, state, work).ok());
    lowest = std::min(lowest, state.x(2, model->probes.front().vertex));
  }
  return lowest;
}

TEST(Cube, OfSpringsCollapsesWhileTensegrityKeepsItsHeight) {
  const double springs = LowestHeightOfP("cube-springs"), tensegrity = LowestHeightOfP("cube-tensegrity");
  RecordProperty("springs_mm", static_cast<int>(1e3 * springs));
  RecordProperty("tensegrity_mm", static_cast<int>(1e3 * tensegrity));
  EXPECT_LT(springs, 5) << "half its height";
  EXPECT_GT(tensegrity, 7.5) << "three quarters of its height";
}

}  // namespace
}  // namespace phrenic
