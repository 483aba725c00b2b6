// The organs that the diaphragm carries stay on their side of it through a breath.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "server/mechanics/skinning/body_points.h"
#include "server/mechanics/step/step.h"
#include "server/mesh/nearest.h"
#include "server/mesh/topology.h"
#include "tests/physiology/generated_thorax.h"

namespace phrenic {
namespace {

Points PlacedByName(const Model& model, const State& state, const std::string& name) {
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    if (model.bodies[b].name != name) continue;
    Points x(3, model.bodies[b].mesh.vertices.cols());
    PlaceBody(model, state, static_cast<int>(b), x);
    return x;
  }
  ADD_FAILURE() << name;
  return {};
}

// Returns the smallest distance of a body from the middle of the diaphragm's two layers, along their normal, of its
// vertices within 20 mm of it [mm]; positive above for `side` 1, below for -1.
double SmallestGap(const Model& model, const State& state, const std::string& organ, double side) {
  const Points layers = PlacedByName(model, state, "diaphragm"), x = PlacedByName(model, state, organ);
  const Points upper = layers(Eigen::all, Eigen::seq(0, Eigen::last, 2));
  const Points lower = layers(Eigen::all, Eigen::seq(1, Eigen::last, 2));
  const Points middle = (upper + lower) / 2;
  const NearestSearch search(middle);
  double smallest = 1;
  for (const auto& point : x.colwise()) {
    const Neighbour at = search.Nearest(point, 0.02);
    if (at.vertex < 0) continue;
    const Eigen::Vector3d normal = (upper.col(at.vertex) - lower.col(at.vertex)).normalized();
    smallest = std::min(smallest, side * normal.dot(point - middle.col(at.vertex)));
  }
  return 1e3 * smallest;
}

class CarriedOrgans : public testing::TestWithParam<const char*> {};

TEST_P(CarriedOrgans, DoNotPierceTheSheetAndKeepTheirSize) {
  static const std::shared_ptr<const Model> model = CompileShipped("thorax");
  v1::Parameters parameters = model->parameters;
  parameters.MergeFrom(*FindPreset(model->scene, GetParam()));
  constexpr double kStep = 1e-3;
  const double end = 0.55 * parameters.breath_length();
  State state = model->InitialState();
  Workspace work = model->MakeWorkspace();
  for (int moment = 0; moment <= 4; ++moment) {
    while (state.time < end * moment / 4) ASSERT_TRUE(Step(*model, parameters, kStep, state, work).ok());
    for (const char* organ : {"liver", "stomach", "spleen"}) {
      EXPECT_GT(SmallestGap(*model, state, organ, -1), 1) << organ << " at " << state.time;
    }
    EXPECT_GT(SmallestGap(*model, state, "heart", 1), 1) << state.time;
  }
  for (const BodyModel& body : model->bodies) {
    if (body.name != "liver" && body.name != "stomach" && body.name != "spleen") continue;
    const double rest = SignedVolume(body.mesh.vertices, body.mesh.triangles);
    EXPECT_NEAR(SignedVolume(PlacedByName(*model, state, body.name), body.mesh.triangles), rest, 0.15 * rest);
  }
}

INSTANTIATE_TEST_SUITE_P(Breaths, CarriedOrgans, testing::Values("quiet", "deep"),
                         [](const auto& breath) { return std::string(breath.param); });

}  // namespace
}  // namespace phrenic
