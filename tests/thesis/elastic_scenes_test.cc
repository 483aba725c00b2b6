// The shipped scenes of elastic tissue show the behaviour that they are made for.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/compile_text.h"
#include "tests/thesis/shipped.h"

namespace phrenic {
namespace {

State After(const Model& model, double time) { return RunTo(model, time, model.parameters.time_step()); }

// Returns the descent of a probe from rest [m].
double Descent(const Model& model, const State& state, size_t probe) {
  const Probe& at = model.probes[probe];
  const int vertex = model.bodies[at.body].first_vertex + at.vertex;
  return model.rest(2, vertex) - state.x(2, vertex);
}

TEST(HangingSheets, OfSpringsAndOfElementsHangAlike) {
  const auto model = CompileText(ShippedScene("hanging-sheet"));
  const State state = After(*model, 20);  // after five breaths of wind, at rest
  const double springs = Descent(*model, state, 0), membrane = Descent(*model, state, 1);
  EXPECT_GT(membrane, 0.01);
  EXPECT_NEAR(springs, membrane, 0.1 * membrane);
}

TEST(MixedMethods, TendonKeepsItsSizeWhileMuscleStretches) {
  const auto model = CompileText(ShippedScene("mixed-methods"));
  const State state = After(*model, 2);
  EXPECT_GT(Descent(*model, state, 0), 0.05);
  const auto length = [&](int a, int b) {
    return (state.x.col(a) - state.x.col(b)).norm() / (model->rest.col(a) - model->rest.col(b)).norm();
  };
  EXPECT_NEAR(length(90, 198), 1, 1e-6);  // across the tendon
  EXPECT_GT(length(136, 141), 1.2);       // from the edge to the tendon
}

TEST(Fibres, FlattenTheDomeAndLetItRiseAgain) {
  const auto model = CompileText(ShippedScene("fibres"));
  const double height = 0.09;
  EXPECT_GT(Descent(*model, After(*model, 2), 0), 0.2 * height);
  EXPECT_LT(std::abs(Descent(*model, After(*model, 4), 0)), 0.02 * height);
}

TEST(LiverAndDiaphragm, MoveTogether) {
  const auto model = CompileText(ShippedScene("fem-liver-diaphragm"));
  const State deep = After(*model, 2), end = After(*model, 4);
  EXPECT_GT(Descent(*model, deep, 0), 0.015);
  EXPECT_GT(Descent(*model, deep, 1), 0.005);
  EXPECT_LT(std::abs(Descent(*model, end, 0)), 0.003);
}

TEST(Muscle, ShortensAndThickensWithTheBreathAndComesBackToRest) {
  const auto model = CompileText(ShippedScene("muscle"));
  const auto read = [&](const State& state, size_t output) {
    return model->forces.front()->Read(output, MakeEvalContext(*model, model->parameters, state));
  };
  const State peak = After(*model, 2), rest = After(*model, 4);
  EXPECT_NEAR(read(peak, 0), 0.84, 0.03) << "stretch of fibres";
  EXPECT_NEAR(read(peak, 1), 1.17, 0.05) << "thickness";
  EXPECT_GT(Descent(*model, peak, 0), 0.01);
  EXPECT_NEAR(read(rest, 0), 1, 2e-3);
  EXPECT_LT((rest.x - model->rest).cwiseAbs().maxCoeff(), 1e-3);
}

}  // namespace
}  // namespace phrenic
