// Lungs between the diaphragm and the wall: what is seen of them passes neither through the sheet nor through ribs.
#include <gtest/gtest.h>

#include <string>

#include "server/mechanics/skinning/body_points.h"
#include "tests/physiology/generated_thorax.h"

namespace phrenic {
namespace {

constexpr int kFew = 10;  // vertices

// The coarse thorax, whose lungs have no obstacle and no wall.
const Model& WithoutLimits() {
  static const auto& model = *new std::shared_ptr<const Model>([] {
    v1::Scene scene = ReadShipped("thorax");
    for (v1::Motion& motion : *scene.mutable_motions()) {
      if (!motion.has_skin()) continue;
      motion.mutable_skin()->clear_obstacle();
      motion.mutable_skin()->clear_wall();
    }
    return CompileScene(scene, [](const v1::Body&) { return 6; });
  }());
  return *model;
}

physiology::Recording SearchedBreath(const Model& model, const std::string& preset) {
  const auto subject = physiology::Subject::Of(model);
  v1::Parameters parameters = model.parameters;
  parameters.MergeFrom(*FindPreset(model.scene, preset));
  return *physiology::Record(**subject, preset, parameters, [](double) { return true; });
}

int RightLung(const Model& model) {
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    if (model.bodies[b].name == "lung-right") return static_cast<int>(b);
  }
  return -1;
}

TEST(LungLimits, LungsRestWhereTheyWereGenerated) {
  const Model& model = *CoarseThorax();
  const int lung = RightLung(model);
  const Points placed = physiology::Placed(model, model.InitialState(), lung);
  EXPECT_LT((placed - model.bodies[static_cast<size_t>(lung)].mesh.vertices).cwiseAbs().maxCoeff(), 1e-15);
}

// The cause is taken away: in a full expiration the ribs then come down through the margins. No step feels the limits.
TEST(LungLimits, WithoutThemRibsComeThroughTheMarginAndNothingElseChanges) {
  const auto with = SearchedBreath(*CoarseThorax(), "full-expiration");
  const auto without = SearchedBreath(WithoutLimits(), "full-expiration");
  EXPECT_LT(with.flaws[physiology::kPiercingLungs], kFew);
  EXPECT_GT(without.flaws[physiology::kPiercingLungs], 100);
  EXPECT_EQ(StateHash(without.peak), StateHash(with.peak));
}

TEST(LungLimits, UprightTheDomesDoNotPassThroughTheLungs) {
  EXPECT_LT(SearchedBreath(*CoarseThorax(), "upright").flaws[physiology::kPiercingLungs], kFew);
}

TEST(LungLimits, AWallNeedsAnObstacle) {
  v1::Scene scene = ReadShipped("thorax");
  for (v1::Motion& motion : *scene.mutable_motions()) {
    if (motion.has_skin()) motion.mutable_skin()->clear_obstacle();
  }
  const auto model = Compile(scene, [](const v1::Body& body) {
    v1::Generated shape = body.generated();
    shape.set_resolution_mm(10);
    return anatomy::Generate(body.anatomy(), shape);
  });
  EXPECT_TRUE(absl::IsInvalidArgument(model.status())) << model.status();
  EXPECT_NE(model.status().message().find(".skin.wall: needs an obstacle"), std::string::npos) << model.status();
}

// Of a moment that goes on evenly for a while: positions are x + t v, and bones follow.
TEST(LungLimits, VelocityIsTheDerivativeOfPosition) {
  constexpr double kTime = 1e-6;
  const Model& model = *CoarseThorax();
  const State moment = CoarseBreath("deep").base;
  const int lung = RightLung(model);
  const auto at = [&](double time) {
    State state = moment;
    state.x += time * state.v;
    const EvalContext now = MakeEvalContext(model, model.parameters, state);
    for (const auto& motion : model.motions) motion->Drive(now, state);
    return physiology::Placed(model, state, lung);
  };
  const Points rates = (at(kTime) - at(-kTime)) / (2 * kTime);
  const Scratch scratch;
  const Points v = BodyPoints(model, lung).Locate(MakeEvalContext(model, model.parameters, moment, scratch)).v;
  EXPECT_GT(rates.colwise().norm().maxCoeff(), 1e-3);
  EXPECT_LT((v - rates).colwise().norm().maxCoeff(), 0.05 * rates.colwise().norm().maxCoeff());
}

}  // namespace
}  // namespace phrenic
