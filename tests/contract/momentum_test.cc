// Internal forces and links sum to zero: a free body keeps its momentum under every integrator but the thesis', and
// does not drift.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "server/mechanics/integrators/catalogue.h"
#include "server/mechanics/step/step_plan.h"
#include "tests/compile_text.h"

namespace phrenic {
namespace {

struct BodyCase {
  const char* name;
  const char* text;
  double most = 1e-9;  // drift of the centre of mass in 100 s [m]
};

#define SHEET                                                                                                       \
  "bodies { name: 'sheet' role: ROLE_DEFORMABLE mass: 2 grid { columns: 5 rows: 4 u { x: 0.1 y: 0.01 } v { y: 0.1 " \
  "z: 0.03 } } } "

const BodyCase kBodies[] = {
    {"springs", SHEET "forces { springs { bodies: 'sheet' stiffness: 300 rest_length_ratio: 0.9 } }"},
    {"stiff",
     SHEET "forces { springs { bodies: 'sheet' stiffness: 30 } } forces { springs { bodies: 'sheet' stiffness: 1e5 } }",
     1e-7},
    {"membrane", SHEET
     "forces { membrane { bodies: 'sheet' youngs_modulus: 9000 thickness: 0.003 } } forces { bending { bodies: 'sheet' "
     "youngs_modulus: 9000 thickness: 0.01 } }"},
    {"links", SHEET
     "forces { springs { bodies: 'sheet' stiffness: 300 } } constraints { rigid_links { body: 'sheet' list { links { "
     "a: 0 b: 1 } links { a: 1 b: 2 } links { a: 8 b: 13 } } } }"},
    {"two", SHEET
     "bodies { name: 'other' role: ROLE_DEFORMABLE mass: 1 grid { columns: 3 rows: 3 u { x: 0.1 } v { z: 0.1 } origin "
     "{ "
     "y: 9 } } } forces { springs { bodies: 'sheet' stiffness: 300 } } forces { springs { bodies: 'other' stiffness: "
     "700 } }"},
    {"gas",
     "bodies { name: 'ball' role: ROLE_DEFORMABLE mass: 1 ellipsoid { radii { x: 0.1 y: 0.12 z: 0.1 } divisions: 2 } } "
     "forces { springs { bodies: 'ball' stiffness: 100 } } forces { pressure { surface { bodies: 'ball' } compliance: "
     "1e-6 } }"},
};

void PrintTo(const BodyCase& body, std::ostream* out) { *out << body.name; }

using Case = std::tuple<BodyCase, const char*>;

class FreeBody : public testing::TestWithParam<Case> {};

// The centre of each body, one column each.
Points Centres(const Model& model, const Points& of) {
  Points centres = Points::Zero(3, static_cast<Eigen::Index>(model.bodies.size()));
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Eigen::Index first = model.bodies[b].first_vertex, count = model.bodies[b].mesh.vertices.cols();
    const auto mass = model.mass.segment(first, count);
    centres.col(static_cast<Eigen::Index>(b)) = of.middleCols(first, count) * mass / mass.sum();
  }
  return centres;
}

// Takes each body's mean velocity from it.
void StopCentres(const Model& model, State& state) {
  const Points velocities = Centres(model, state.v);
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    auto v = state.v.middleCols(model.bodies[b].first_vertex, model.bodies[b].mesh.vertices.cols());
    v.colwise() -= Eigen::Vector3d(velocities.col(static_cast<Eigen::Index>(b)));
  }
}

#ifdef PHRENIC_SANITIZED
constexpr double kOfTheTime = 0.1;  // enough for sanitizers; the Release build runs the whole time
#else
constexpr double kOfTheTime = 1;
#endif

TEST_P(FreeBody, DoesNotDriftInAHundredSeconds) {
  const auto& [body, integrator] = GetParam();
  const auto model = CompileText(std::string("name: 'free' ") + body.text + " parameters { integrator: INTEGRATOR_" +
                                 integrator + " }");
  ASSERT_NE(model, nullptr);
  const bool limited = std::isfinite(FindIntegrator(model->parameters.integrator()).MaxStep({.omega_max = 1}));
  const double dt = limited ? std::min(0.01, 0.5 * model->report.stable_step().seconds()) : 0.01;
  State state = model->InitialState();
  std::mt19937 random(3);
  std::uniform_real_distribution<double> rate(-0.1, 0.1);
  for (double& v : state.v.reshaped()) v = rate(random);
  StopCentres(*model, state);
  model->plan->ProjectVelocities(model->parameters, Scratch(), state);
  const Points start = Centres(*model, state.x);
  Workspace work = model->MakeWorkspace();
  const int steps = static_cast<int>(std::lround(kOfTheTime * (limited ? 10 : 100) / dt));
  for (int i = 0; i < steps; ++i) {
    const absl::Status stepped = Step(*model, model->parameters, dt, state, work);
    ASSERT_TRUE(stepped.ok()) << i << ": " << stepped;
  }
  const Points drift = Centres(*model, state.x) - start;
  EXPECT_LT(drift.colwise().norm().maxCoeff(), body.most) << dt;
}

INSTANTIATE_TEST_SUITE_P(
    Bodies, FreeBody,
    testing::Combine(testing::ValuesIn(kBodies),
                     testing::Values("SEMI_IMPLICIT_EULER", "VELOCITY_VERLET", "RUNGE_KUTTA_4", "LINEAR_IMPLICIT_EULER",
                                     "BDF2", "TR_BDF2", "PROJECTIVE_DYNAMICS")),
    [](const auto& test) { return std::string(std::get<0>(test.param).name) + "_" + std::get<1>(test.param); });

}  // namespace
}  // namespace phrenic
