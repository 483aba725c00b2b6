// The laws that every integrator keeps. A new one joins with one line in kIntegrators.
#include <gtest/gtest.h>

#include <cmath>

#include "absl/strings/str_format.h"
#include "server/mechanics/catalogue.h"
#include "server/mechanics/spectrum.h"
#include "tests/compile_text.h"

namespace phrenic {
namespace {

struct IntegratorCase {
  const char* name;
  const char* text;
};

const IntegratorCase kIntegrators[] = {
    {"semi_implicit_euler", "INTEGRATOR_SEMI_IMPLICIT_EULER"},
};

// A free mass of 1 kg on a spring of rest length 1 m from a fixed one; x(0) is `stretch` beyond it.
std::string Oscillator(const std::string& integrator, double stiffness, double friction, double stretch = 0.125) {
  const double length = 1 + stretch;
  return "name: 'oscillator' bodies { name: 'pair' role: ROLE_DEFORMABLE mass: 2 fixed_vertices: 0 polyhedron { "
         "vertices {} vertices { x: " +
         absl::StrFormat("%.17g", length) + " } edges { a: 0 b: 1 } } } forces { springs { bodies: 'pair' stiffness: " +
         absl::StrFormat("%.17g rest_length_ratio: %.17g", stiffness, 1 / length) +
         " } } forces { friction { bodies: 'pair' rate: " + absl::StrFormat("%.17g", friction) +
         " } } parameters { integrator: " + integrator + " }";
}

void PrintTo(const IntegratorCase& integrator, std::ostream* out) { *out << integrator.name; }

class IntegratorContract : public testing::TestWithParam<IntegratorCase> {};

TEST_P(IntegratorContract, ConvergesAtItsOrder) {
  const auto model = CompileText(Oscillator(GetParam().text, 40, 0.8));
  const double c = 0.8, omega = std::sqrt(40 - c * c / 4), t = 1.0;
  const double exact = 1 + 0.125 * std::exp(-c * t / 2) * (std::cos(omega * t) + c / (2 * omega) * std::sin(omega * t));
  const auto error = [&](double dt) { return std::abs(RunTo(*model, t, dt).x(0, 1) - exact); };
  const double measured = std::log2(error(1e-3) / error(5e-4));
  EXPECT_NEAR(measured, FindIntegrator(model->parameters.integrator()).order(), 0.1);
}

// One step below the predicted limit stays for ever, one above it does not.
TEST_P(IntegratorContract, StatesItsStabilityLimit) {
  for (const double friction : {0.0, 5.0}) {
    const auto model = CompileText(Oscillator(GetParam().text, 100, friction, 0.01));
    const FastestMode mode = FindFastestMode(*model, model->parameters, model->InitialState());
    const double limit = FindIntegrator(model->parameters.integrator()).MaxStep(mode.spectrum);
    const auto ends_well = [&](double dt) {
      State state = model->InitialState();
      Workspace work = model->MakeWorkspace();
      for (int i = 0; i < 2'000; ++i) {
        if (!Step(*model, model->parameters, dt, state, work).ok()) return false;
        if ((state.x - model->rest).cwiseAbs().maxCoeff() > 0.3) return false;  // it started with 0.01
      }
      return true;
    };
    EXPECT_TRUE(ends_well(0.98 * limit)) << "friction " << friction;
    EXPECT_FALSE(ends_well(1.05 * limit)) << "friction " << friction;
  }
}

TEST_P(IntegratorContract, RepeatsBitForBitAlsoAfterASnapshot) {
  const auto model = CompileText(Oscillator(GetParam().text, 40, 0.1));
  const State whole = RunTo(*model, 2, 1e-3);
  State state = RunTo(*model, 1, 1e-3);
  const State snapshot = state;
  Workspace work = model->MakeWorkspace();
  State resumed = snapshot;
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(Step(*model, model->parameters, 1e-3, resumed, work).ok());
  EXPECT_EQ(StateHash(resumed), StateHash(whole));
}

TEST_P(IntegratorContract, FixedVerticesStay) {
  const auto model = CompileText(Oscillator(GetParam().text, 40, 0.1));
  EXPECT_EQ(RunTo(*model, 2, 1e-3).x.col(0), model->rest.col(0));
}

INSTANTIATE_TEST_SUITE_P(Integrators, IntegratorContract, testing::ValuesIn(kIntegrators),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace phrenic
