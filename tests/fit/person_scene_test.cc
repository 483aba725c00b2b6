// A person's breath as a scene: what it moves is what was fitted.
#include "server/fit/person_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/mechanics/compile/compile.h"
#include "server/mechanics/step/step.h"
#include "tests/fit/synthetic_person.h"

namespace phrenic::fit {
namespace {

v1::Body LungBody(Side side) {
  v1::Body body;
  body.set_name(side == kLeft ? "lung-left" : "lung-right");
  body.set_role(v1::ROLE_SEEN);
  body.mutable_anatomy()->set_structure(v1::STRUCTURE_LUNG);
  body.mutable_anatomy()->set_side(side == kLeft ? v1::SIDE_LEFT : v1::SIDE_RIGHT);
  body.mutable_generated()->set_resolution_mm(8);
  return body;
}

class PersonSceneTest : public testing::Test {
 protected:
  static const MotionFit& Fitted() {
    static const auto* const fit = new MotionFit(*FitMotion(GeneratedLungs(), SyntheticPerson(), {}));
    return *fit;
  }
  static v1::Scene Scene() {
    return PersonScene({"anna",
                        "A person made up.",
                        {LungBody(kRight), LungBody(kLeft)},
                        Fitted().registered,
                        PresetsOf(Fitted(), BreathAmplitudes(8))},
                       GeneratedLungs());
  }
  static std::shared_ptr<const Model> Compiled(const v1::Scene& scene) {
    const auto source = [](const v1::Body& body) -> absl::StatusOr<Mesh> {
      return GeneratedLung(body.anatomy().side() == v1::SIDE_LEFT ? kLeft : kRight);
    };
    auto model = Compile(scene, source, {});
    EXPECT_TRUE(model.ok()) << model.status();
    return model.ok() ? *model : nullptr;
  }
  // The state at the peak of a breath with these parameters.
  static State AtPeak(const Model& model, const v1::Parameters& parameters) {
    State state = model.InitialState();
    Workspace work = model.MakeWorkspace();
    for (int i = 0; i < 200; ++i) EXPECT_TRUE(Step(model, parameters, 0.01, state, work).ok());
    return state;
  }
  static const BodyModel& BodyOf(const Model& model, const std::string& name) {
    return *std::find_if(model.bodies.begin(), model.bodies.end(), [&](const auto& body) { return body.name == name; });
  }
};

TEST_F(PersonSceneTest, MovesItsTissueAsTheFitDoes) {
  v1::Scene scene = Scene();
  AddLandmarks(Fitted(), 100, scene);
  const auto model = Compiled(scene);
  ASSERT_NE(model, nullptr);
  const State state = AtPeak(*model, model->parameters);
  const BodyModel& balls = BodyOf(*model, "landmarks");
  ASSERT_EQ(balls.mesh.vertices.cols(), 600);
  double worst = 0;
  for (int k = 0; k < 100; ++k) {
    const auto held_out = static_cast<int>(Fitted().halves.held_out.size());
    const int i = Fitted().halves.held_out[static_cast<size_t>(k) * held_out / 100];
    const Eigen::Vector3d moved = (state.x.middleCols(balls.first_vertex + 6 * k, 6).rowwise().mean() -
                                   model->rest.middleCols(balls.first_vertex + 6 * k, 6).rowwise().mean());
    worst = std::max(worst, (moved - Fitted().predicted.col(i)).norm());
  }
  EXPECT_LT(worst, 1e-4);
}

TEST_F(PersonSceneTest, GainsTheFittedVolume) {
  const auto model = Compiled(Scene());
  ASSERT_NE(model, nullptr);
  const auto volume = [&](const State& state) {
    double sum = 0;
    for (const BodyModel& body : model->bodies) {
      for (const auto& t : body.mesh.triangles.colwise()) {
        const auto at = [&](int k) -> Eigen::Vector3d { return state.x.col(body.first_vertex + t[k]); };
        sum += at(0).dot(at(1).cross(at(2))) / 6;
      }
    }
    return sum;
  };
  const double gain = volume(AtPeak(*model, model->parameters)) - volume(model->InitialState());
  EXPECT_GT(gain, 1e-4);
  EXPECT_NEAR(gain, Fitted().volume, 0.1 * Fitted().volume) << "of first order in the motion";
}

TEST_F(PersonSceneTest, HasPartsThatAddUpToTheWhole) {
  const auto model = Compiled(Scene());
  ASSERT_NE(model, nullptr);
  const auto motion = [&](const std::string& name) -> Points {
    for (const v1::Preset& preset : model->scene.presets()) {
      if (preset.name() != name) continue;
      v1::Parameters parameters = model->parameters;
      parameters.MergeFrom(preset.parameters());
      return AtPeak(*model, parameters).x - model->rest;
    }
    ADD_FAILURE() << name;
    return {};
  };
  const Points fitted = motion("fitted"), bases = motion("bases-alone"), walls = motion("walls-alone");
  EXPECT_GT(bases.norm(), 0.5 * fitted.norm());
  EXPECT_GT(walls.norm(), 0.02 * fitted.norm());
  EXPECT_LT((bases + walls - fitted).norm(), 1e-9);
  EXPECT_GT((motion("expected") - fitted).norm(), 0.05 * fitted.norm());
}

TEST_F(PersonSceneTest, HoldsNoneOfThePersonsPointsUnlessAsked) {
  const v1::Scene scene = Scene();
  EXPECT_EQ(scene.bodies_size(), 2);
  for (const v1::Body& body : scene.bodies()) EXPECT_TRUE(body.has_generated());
  EXPECT_THAT(scene.DebugString(), testing::Not(testing::HasSubstr("polyhedron")));
}

}  // namespace
}  // namespace phrenic::fit
