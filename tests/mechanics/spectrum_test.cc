#include "server/mechanics/stability/spectrum.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "absl/strings/str_cat.h"
#include "server/mechanics/integrators/catalogue.h"
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

// Two vertices on springs of their own, far apart: a stiff one, and one whose friction is for itself.
std::shared_ptr<const Model> StiffAndDamped(double stiffness, double friction) {
  const std::string pair =
      " role: ROLE_DEFORMABLE mass: 2 fixed_vertices: 0 polyhedron { vertices {} vertices { x: 1 } "
      "edges { a: 0 b: 1 } } } ";
  return CompileText(absl::StrCat("name: 'two' bodies { name: 'stiff'", pair, "bodies { name: 'damped'", pair,
                                  "forces { springs { bodies: 'stiff' stiffness: ", stiffness,
                                  " } } forces { springs { bodies: 'damped' stiffness: 100 } } "
                                  "forces { friction { bodies: 'damped' rate: ",
                                  friction, " } } parameters { integrator: INTEGRATOR_SEMI_IMPLICIT_EULER }"));
}

// A frequency and a damping rate that do not meet in one mode do not add up: each has its own limit.
TEST(Spectrum, CountsTheDampingOfTheModeThatLimitsTheStep) {
  struct Case {
    double stiffness, friction;
  };
  for (const auto& [stiffness, friction] : {Case{1e6, 1}, Case{1e6, 300}, Case{1e6, 3'000}, Case{1e4, 3e5}}) {
    const auto model = StiffAndDamped(stiffness, friction);
    ASSERT_NE(model, nullptr);
    const Integrator& euler = FindIntegrator(v1::INTEGRATOR_SEMI_IMPLICIT_EULER);
    const double stiff = 2 / std::sqrt(stiffness), damped = euler.MaxStep({.omega_max = 10, .damping_rate = friction});
    const FastestMode mode = FindFastestMode(*model, model->parameters, model->InitialState());
    EXPECT_NEAR(euler.MaxStep(mode.spectrum), std::min(stiff, damped), 1e-6 * std::min(stiff, damped)) << friction;
    EXPECT_EQ(mode.vertex, stiff < damped ? 1 : 3) << friction;
  }
}

}  // namespace
}  // namespace phrenic
