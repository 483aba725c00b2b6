// What people are told of the forces is what moves the vertices.
#include "server/mechanics/step/force_reading.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/compile_text.h"
#include "tests/small_scenes.h"

namespace phrenic {
namespace {

using testing::ElementsAre;

// A triangle that falls and breathes, pulled at, with links between its corners where `links` is said.
std::shared_ptr<const Model> Falling(const std::string& links) {
  return CompileText(Triangle(R"(forces { gravity { bodies: "sheet" acceleration { x: 0.3 } } }
    forces { action_line { bodies: "sheet" origin {} direction { y: 1 } radius: 3 force: 1 } } )" +
                              links));
}

constexpr char kLinks[] =
    "constraints { rigid_links { body: 'sheet' list { links { a: 0 b: 1 } links { a: 1 b: 2 } } } }";

v1::Parameters ShortStep(const Model& model) {
  v1::Parameters parameters = model.parameters;
  parameters.set_time_step(1e-3);
  return parameters;
}

State Later(const Model& model) {
  State state = RunTo(model, 0.4, 1e-3);
  state.pulls = {{.vertex = 1, .force = {0.1, -0.2, 0.3}}};
  return state;
}

TEST(ForceReading, NamesEachKindOnceAndWhatComesWithConstraintsAndPulls) {
  const auto model = Falling(kLinks), loose = Falling("");
  const ForceReading still(*model, model->parameters, model->InitialState());
  EXPECT_THAT(still.kinds(), ElementsAre("springs", "friction", "gravity", "action_line", "constraints", "net"));
  const ForceReading pulled(*loose, loose->parameters, Later(*loose));
  EXPECT_THAT(pulled.kinds(), ElementsAre("springs", "friction", "gravity", "action_line", "pull", "net"));
}

TEST(ForceReading, KindsSumToTheNetForce) {
  const auto model = Falling(kLinks);
  const ForceReading reading(*model, ShortStep(*model), Later(*model));
  Points sum = Points::Zero(3, model->rest.cols());
  for (const std::string& kind : reading.kinds()) {
    if (kind != "net") sum += reading.Of(kind);
  }
  EXPECT_LT((sum - reading.Of("net")).norm(), 1e-12 * sum.norm());
}

TEST(ForceReading, TheNetForceIsMassTimesWhatTheNextStepAccelerates) {
  for (const char* links : {"", kLinks}) {
    const auto model = Falling(links);
    const v1::Parameters parameters = ShortStep(*model);
    State state = Later(*model);
    const Points net = ForceReading(*model, parameters, state).Of("net"), before = state.v;
    Workspace work = model->MakeWorkspace();
    ASSERT_TRUE(Step(*model, parameters, parameters.time_step(), state, work).ok());
    for (const int free : {1, 2}) {
      const Eigen::Vector3d felt = model->mass[free] * (state.v - before).col(free) / parameters.time_step();
      EXPECT_LT((felt - net.col(free)).norm(), 1e-9 * felt.norm()) << links << free;
    }
  }
}

TEST(ForceReading, AWeightThatHangsOnALinkIsHeldByIt) {
  const auto model = CompileText(R"(name: "weight" title: "Weight"
    bodies { name: "string" role: ROLE_DEFORMABLE mass: 2 fixed_vertices: [0]
      polyhedron { vertices {} vertices { z: -1 } edges { a: 0 b: 1 } } }
    forces { gravity { bodies: "string" acceleration { z: -10 } } }
    constraints { rigid_links { body: "string" list { links { a: 0 b: 1 } } } }
    parameters { time_step: 0.001 })");
  const ForceReading reading(*model, model->parameters, model->InitialState());
  const double weight = 10 * model->mass[1];
  EXPECT_NEAR(reading.Of("gravity")(2, 1), -weight, 1e-12);
  EXPECT_NEAR(reading.Of("constraints")(2, 1), weight, 1e-9);
  EXPECT_NEAR(reading.Of("net").col(1).norm(), 0, 1e-9);
}

}  // namespace
}  // namespace phrenic
