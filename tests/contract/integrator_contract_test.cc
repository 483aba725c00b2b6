// The laws that every integrator keeps. A new one joins with one line in kIntegrators.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "absl/strings/str_format.h"
#include "server/mechanics/integrators/catalogue.h"
#include "server/mechanics/stability/spectrum.h"
#include "server/mechanics/step/step_checkpoint.h"
#include "tests/compile_text.h"
#include "tests/contract/allocations.h"

namespace phrenic {
namespace {

struct IntegratorCase {
  const char* name;
  double step;  // at which its order shows: small enough to be in its limit, large enough to be above rounding [s]
};

const IntegratorCase kIntegrators[] = {
    {"SEMI_IMPLICIT_EULER", 1e-3},
    {"THESIS", 1e-5},
    {"EXPLICIT_EULER", 1e-4},
    {"VELOCITY_VERLET", 1e-2},
    {"RUNGE_KUTTA_4", 5e-3},
    {"LINEAR_IMPLICIT_EULER", 1e-4},
    {"BDF2", 2e-3},
    {"TR_BDF2", 1e-2},
    {"STATIC", 1e-2},
    {"PROJECTIVE_DYNAMICS", 1e-4},
};

// A free mass of 1 kg on a spring of rest length 1 m from a fixed one; x(0) is `stretch` beyond it.
std::string Oscillator(const IntegratorCase& integrator, double stiffness, double friction, double stretch = 0.125) {
  const double length = 1 + stretch;
  return "name: 'oscillator' bodies { name: 'pair' role: ROLE_DEFORMABLE mass: 2 fixed_vertices: 0 polyhedron { "
         "vertices {} vertices { x: " +
         absl::StrFormat("%.17g", length) + " } edges { a: 0 b: 1 } } } forces { springs { bodies: 'pair' stiffness: " +
         absl::StrFormat("%.17g rest_length_ratio: %.17g", stiffness, 1 / length) +
         " } } forces { friction { bodies: 'pair' rate: " + absl::StrFormat("%.17g", friction) +
         " } } parameters { integrator: INTEGRATOR_" + integrator.name + " }";
}

const Integrator& Method(const Model& model) { return FindIntegrator(model.parameters.integrator()); }

void PrintTo(const IntegratorCase& integrator, std::ostream* out) { *out << integrator.name; }

class IntegratorContract : public testing::TestWithParam<IntegratorCase> {};

TEST_P(IntegratorContract, ConvergesAtItsOrder) {
  const auto model = CompileText(Oscillator(GetParam(), 40, 0.8));
  const double c = 0.8, omega = std::sqrt(40 - c * c / 4), t = 1.0;
  const double exact = 1 + 0.125 * std::exp(-c * t / 2) * (std::cos(omega * t) + c / (2 * omega) * std::sin(omega * t));
  const auto error = [&](double dt) { return std::abs(RunTo(*model, t, dt).x(0, 1) - exact); };
  const double measured = std::log2(error(GetParam().step) / error(GetParam().step / 2));
  const int order = Method(*model).order();
  if (order > 0) {
    EXPECT_NEAR(measured, order, 0.1);
  } else {
    EXPECT_LT(measured, 0.1) << "it converges after all";
  }
}

// Whether the oscillator, let go 0.01 m from its rest, stays near it.
bool StaysNear(const Model& model, double dt) {
  State state = model.InitialState();
  Workspace work = model.MakeWorkspace();
  for (int i = 0; i < 2'000; ++i) {
    if (!Step(model, model.parameters, dt, state, work).ok()) return false;
    if ((state.x - model.rest).cwiseAbs().maxCoeff() > 0.3) return false;
  }
  return true;
}

// One step below the predicted limit stays for ever, one above it does not.
TEST_P(IntegratorContract, StatesItsStabilityLimit) {
  for (const double friction : {0.0, 5.0}) {
    const auto model = CompileText(Oscillator(GetParam(), 100, friction, 0.01));
    const FastestMode mode = FindFastestMode(*model, model->parameters, model->InitialState());
    const double limit = Method(*model).MaxStep(mode.spectrum);
    EXPECT_TRUE(limit == 0 || StaysNear(*model, std::min(0.98 * limit, 10.0))) << "friction " << friction;
    EXPECT_FALSE(std::isfinite(limit) && StaysNear(*model, std::max(1.05 * limit, 0.01))) << "friction " << friction;
  }
}

TEST_P(IntegratorContract, RepeatsBitForBitAlsoAfterASnapshot) {
  const auto model = CompileText(Oscillator(GetParam(), 40, 0.1));
  const State whole = RunTo(*model, 2, 1e-3);
  State state = RunTo(*model, 1, 1e-3);
  const State snapshot = state;
  Workspace work = model->MakeWorkspace();
  State resumed = snapshot;
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(Step(*model, model->parameters, 1e-3, resumed, work).ok());
  EXPECT_EQ(StateHash(resumed), StateHash(whole));
}

// Ten steps by another one in between leave no trace but where they lead.
TEST_P(IntegratorContract, MayBeChangedBetweenTwoSteps) {
  const auto model = CompileText(Oscillator(GetParam(), 40, 0.1));
  v1::Parameters other = model->parameters;
  other.set_integrator(v1::INTEGRATOR_SEMI_IMPLICIT_EULER);
  State state = RunTo(*model, 0.1, 1e-3);
  Workspace work = model->MakeWorkspace();
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(Step(*model, other, 1e-3, state, work).ok());
  State fresh = state;
  fresh.history = {};
  for (int i = 0; i < 10; ++i) {
    ASSERT_TRUE(Step(*model, model->parameters, 1e-3, state, work).ok());
    ASSERT_TRUE(Step(*model, model->parameters, 1e-3, fresh, work).ok());
  }
  EXPECT_EQ(StateHash(state), StateHash(fresh));
}

// With a tolerance a step far too long is as right as many short ones.
TEST_P(IntegratorContract, AdaptsToItsTolerance) {
  const auto model = CompileText(Oscillator(GetParam(), 40, 0.8));
  if (Method(*model).order() == 0) GTEST_SKIP() << "does not converge";
  v1::Parameters loose = model->parameters, tight = model->parameters;
  loose.set_step_tolerance(1e-4), tight.set_step_tolerance(1e-8);
  const auto error = [&](const v1::Parameters& parameters) {
    State state = model->InitialState();
    Workspace work = model->MakeWorkspace();
    for (int i = 0; i < 10; ++i) EXPECT_TRUE(Step(*model, parameters, 0.1, state, work).ok());
    const double c = 0.8, omega = std::sqrt(40 - c * c / 4);
    return std::abs(state.x(0, 1) - 1 -
                    0.125 * std::exp(-c / 2) * (std::cos(omega) + c / (2 * omega) * std::sin(omega)));
  };
  EXPECT_LT(error(tight), 0.25 * error(loose));
  EXPECT_LT(error(tight), 1e-3);
}

TEST_P(IntegratorContract, AllocatesNothingInAStep) {
  const auto model = CompileText(Oscillator(GetParam(), 40, 0.1));
  State state = model->InitialState();
  state.pulls = {{1, {1, 0, 0}}};
  Workspace work = model->MakeWorkspace();
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(Step(*model, model->parameters, 1e-3, state, work).ok());
  const std::int64_t before = Allocations();
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(Step(*model, model->parameters, 1e-3, state, work).ok());
  EXPECT_EQ(Allocations(), before);
}

// Links in the step, and an inextensible cable.
TEST_P(IntegratorContract, AllocatesNothingInAStepWithLinks) {
  const auto model = CompileText(
      "name: 'links' bodies { name: 'net' role: ROLE_DEFORMABLE mass: 2 fixed_vertices: [0, 2] grid { columns: 3 rows: "
      "3 u { x: 0.1 } v { y: 0.1 } } } forces { springs { bodies: 'net' stiffness: 400 } } forces { gravity { bodies: "
      "'net' acceleration { z: -1 } } } constraints { rigid_links { body: 'net' list { links { a: 3 b: 4 } links { a: "
      "4 b: 5 } } } } constraints { length_limits { body: 'net' list { links { a: 1 b: 7 } } at_most_ratio: 1 } } "
      "parameters { integrator: INTEGRATOR_" +
      std::string(GetParam().name) + " }");
  ASSERT_NE(model, nullptr);
  if (model->parameters.integrator() == v1::INTEGRATOR_THESIS) GTEST_SKIP() << "its vertices are heavier";
  State state = model->InitialState();
  Workspace work = model->MakeWorkspace();
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(Step(*model, model->parameters, 1e-3, state, work).ok());
  const std::int64_t before = Allocations();
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(Step(*model, model->parameters, 1e-3, state, work).ok());
  EXPECT_EQ(Allocations(), before);
}

// A row of three: driven, linked to it, held by a spring.
std::string DrivenRow(const IntegratorCase& integrator) {
  return "name: 'row' bodies { name: 'row' role: ROLE_DEFORMABLE mass: 3 polyhedron { vertices {} vertices { x: 0.1 } "
         "vertices { x: 0.2 } edges { a: 1 b: 2 } } } forces { springs { bodies: 'row' stiffness: 40 } } "
         "motions { oscillation { body: 'row' vertices: 0 amplitude { y: 0.01 } period: 1 } } "
         "constraints { rigid_links { body: 'row' list { links { a: 0 b: 1 } } } } parameters { integrator: "
         "INTEGRATOR_" +
         std::string(integrator.name) + " }";
}

TEST_P(IntegratorContract, TheStartOfAStepIsFoundOnceMore) {
  const auto model = CompileText(DrivenRow(GetParam()));
  ASSERT_NE(model, nullptr);
  for (const double tolerance : {0.0, 1e-4}) {
    v1::Parameters parameters = model->parameters;
    parameters.set_step_tolerance(tolerance);
    State state = RunTo(*model, 0.1, 1e-3);
    Workspace work = model->MakeWorkspace(), other = model->MakeWorkspace();
    StepCheckpoint trail;
    for (int i = 0; i < 70; ++i) {
      if (i == 3) state.v *= 1.1, trail.Forget();
      const State start = state;
      trail.Note(*model, parameters, state);
      ASSERT_TRUE(Step(*model, parameters, 1e-3, state, work).ok());
      EXPECT_NE(state.x, start.x);
      const State found = trail.StateBeforeLastStep(*model, parameters, 1e-3, other);
      EXPECT_EQ(StateHash(found), StateHash(start)) << i;
      EXPECT_EQ(found.tick, start.tick);
    }
  }
}

TEST_P(IntegratorContract, FixedVerticesStay) {
  const auto model = CompileText(Oscillator(GetParam(), 40, 0.1));
  EXPECT_EQ(RunTo(*model, 2, 1e-3).x.col(0), model->rest.col(0));
}

INSTANTIATE_TEST_SUITE_P(Integrators, IntegratorContract, testing::ValuesIn(kIntegrators),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace phrenic
