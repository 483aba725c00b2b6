// The organs that the diaphragm carries stay on their side of it through a breath.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "server/mechanics/skinning/body_points.h"
#include "server/mechanics/step/step.h"
#include "server/mesh/nearest.h"
#include "server/mesh/self_crossings.h"
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

// Compiled once.
const std::shared_ptr<const Model>& CarriedThorax() {
  static const std::shared_ptr<const Model> model = CompileShipped("thorax");
  return model;
}

class CarriedOrgans : public testing::TestWithParam<const char*> {};

TEST_P(CarriedOrgans, DoNotPierceTheSheetAndKeepTheirSize) {
  const auto& model = CarriedThorax();
  v1::Parameters parameters = model->parameters;
  parameters.MergeFrom(*FindPreset(model->scene, GetParam()));
  constexpr double kStep = 1e-3;
  const double end = 0.55 * parameters.breath_length();
  State state = model->InitialState();
  Workspace work = model->MakeWorkspace();
  for (int moment = 0; moment <= 4; ++moment) {
    while (state.time < end * moment / 4) ASSERT_TRUE(Step(*model, parameters, kStep, state, work).ok());
    for (const char* organ : {"liver", "stomach", "spleen", "kidney-right", "kidney-left"}) {
      EXPECT_GT(SmallestGap(*model, state, organ, -1), 1) << organ << " at " << state.time;
    }
    EXPECT_GT(SmallestGap(*model, state, "heart", 1), 1) << state.time;
  }
  for (const BodyModel& body : model->bodies) {
    const auto structure = body.anatomy.structure();
    if (structure != v1::STRUCTURE_LIVER && structure != v1::STRUCTURE_STOMACH && structure != v1::STRUCTURE_SPLEEN &&
        structure != v1::STRUCTURE_KIDNEY) {
      continue;
    }
    const double rest = SignedVolume(body.mesh.vertices, body.mesh.triangles);
    EXPECT_NEAR(SignedVolume(PlacedByName(*model, state, body.name), body.mesh.triangles), rest, 0.15 * rest);
  }
}

// Returns the number of edges of either body that pierce the other.
int CrossingsOf(const Model& model, const State& state, const std::string& name, const std::string& other) {
  constexpr double kCell = 0.005;  // [m]
  Points x(3, 0);
  Triangles triangles(3, 0);
  int apart = 0;
  for (const std::string& body : {name, other}) {
    const Points placed = PlacedByName(model, state, body);
    const auto found = std::ranges::find(model.bodies, body, &BodyModel::name);
    if (found == model.bodies.end()) return -1;
    const Triangles& surface = found->mesh.triangles;
    apart += SelfCrossings(placed, surface, kCell);
    const Eigen::Index before = x.cols();
    x.conservativeResize(3, before + placed.cols());
    x.rightCols(placed.cols()) = placed;
    triangles.conservativeResize(3, triangles.cols() + surface.cols());
    triangles.rightCols(surface.cols()) = surface.array() + static_cast<int>(before);
  }
  return SelfCrossings(x, triangles, kCell) - apart;
}

class CarriedAorta : public testing::TestWithParam<const char*> {};

TEST_P(CarriedAorta, TouchesNeitherTheSheetNorTheGulletNorTheSpine) {
  const auto& model = CarriedThorax();
  v1::Parameters parameters = model->parameters;
  parameters.MergeFrom(*FindPreset(model->scene, GetParam()));
  State state = model->InitialState();
  Workspace work = model->MakeWorkspace();
  for (int moment = 0; moment <= 8; ++moment) {
    while (state.time < parameters.breath_length() * moment / 8) {
      ASSERT_TRUE(Step(*model, parameters, 1e-3, state, work).ok());
    }
    std::vector<std::string> others = {"diaphragm", "oesophagus", "trachea", "superior-vena-cava",
                                       "inferior-vena-cava"};
    for (int i = 1; i <= 12; ++i) others.push_back("t" + std::to_string(i));
    for (const char* lumbar : {"l1", "l2", "l3"}) others.emplace_back(lumbar);
    for (const std::string& other : others) {
      EXPECT_EQ(CrossingsOf(*model, state, "aorta", other), 0) << other << " at " << state.time;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Breaths, CarriedAorta, testing::Values("quiet", "deep"),
                         [](const auto& breath) { return std::string(breath.param); });

// Returns the model at the end of an inspiration, computed once for each preset.
const State& AtEndOfInspiration(const Model& model, const std::string& preset) {
  static std::map<std::string, State>& states = *new std::map<std::string, State>;
  if (const auto found = states.find(preset); found != states.end()) return found->second;
  v1::Parameters parameters = model.parameters;
  parameters.MergeFrom(*FindPreset(model.scene, preset));
  State state = model.InitialState();
  Workspace work = model.MakeWorkspace();
  while (state.time < 0.55 * parameters.breath_length()) {
    if (!Step(model, parameters, 1e-3, state, work).ok()) ADD_FAILURE() << state.time;
  }
  return states.emplace(preset, std::move(state)).first->second;
}

// Returns how far the middle of a body has moved down [mm].
double DescentOf(const Model& model, const State& state, const std::string& name) {
  return 1e3 * (PlacedByName(model, model.InitialState(), name) - PlacedByName(model, state, name)).row(2).mean();
}

// 0.6 to 0.7 of the dome's descent (Song et al., J Magn Reson Imaging 2011;33:143), 4.5 to 9.8 mm in free breathing
// (interquartile range of 62 people, Radiat Oncol 2013;8:248), 39 mm from full expiration to full inspiration
// (Radiother Oncol 1994;32:84), of which a deep breath from rest is a part.
TEST(CarriedKidneys, DescendAboutAsPeoplesDo) {
  const auto& model = CarriedThorax();
  const State quiet = AtEndOfInspiration(*model, "quiet"), deep = AtEndOfInspiration(*model, "deep");
  for (const char* kidney : {"kidney-right", "kidney-left"}) {
    EXPECT_GT(DescentOf(*model, quiet, kidney), 4.5) << kidney;
    EXPECT_LT(DescentOf(*model, quiet, kidney), 11) << kidney;
    EXPECT_GT(DescentOf(*model, deep, kidney), 12) << kidney;
    EXPECT_LT(DescentOf(*model, deep, kidney), 39) << kidney;
  }
}

// The sternal end of a clavicle goes with the manubrium; its other end and the scapula stay, and it keeps its length.
TEST(CarriedClavicles, HangBetweenManubriumAndScapula) {
  const auto& model = CarriedThorax();
  const State deep = AtEndOfInspiration(*model, "deep"), rest = model->InitialState();
  for (const char* name : {"clavicle-right", "clavicle-left"}) {
    const Points at_rest = PlacedByName(*model, rest, name), moved = PlacedByName(*model, deep, name);
    Eigen::Index medial = 0, lateral = 0;
    at_rest.row(0).cwiseAbs().minCoeff(&medial);
    at_rest.row(0).cwiseAbs().maxCoeff(&lateral);
    EXPECT_GT(moved(2, medial) - at_rest(2, medial), 5e-3) << name;
    EXPECT_LT((moved.col(lateral) - at_rest.col(lateral)).norm(), 2e-3) << name;
    const double length = (at_rest.col(medial) - at_rest.col(lateral)).norm();
    EXPECT_NEAR((moved.col(medial) - moved.col(lateral)).norm(), length, 0.06 * length) << name;
  }
}

// Lobes do not pass through each other, nor through the sheet, as far as the lungs do not.
TEST(CarriedLobes, KeepTogetherInADeepBreath) {
  const auto& model = CarriedThorax();
  const State deep = AtEndOfInspiration(*model, "deep");
  for (const std::string side : {"right", "left"}) {
    const NearestSearch lower(PlacedByName(*model, deep, "lobe-lower-" + side));
    const NearestSearch at_rest(PlacedByName(*model, model->InitialState(), "lobe-lower-" + side));
    const Points upper = PlacedByName(*model, deep, "lobe-upper-" + side);
    const Points upper_at_rest = PlacedByName(*model, model->InitialState(), "lobe-upper-" + side);
    double nearest = 1, largest = 0;
    for (Eigen::Index i = 0; i < upper.cols(); ++i) {
      const double before = at_rest.Nearest(upper_at_rest.col(i)).distance, now = lower.Nearest(upper.col(i)).distance;
      nearest = std::min(nearest, now);
      if (before < 4e-3) largest = std::max(largest, now);
    }
    EXPECT_GT(nearest, 2e-4) << side;
    EXPECT_LT(largest, 9e-3) << "the fissure does not open: " << side;
  }
}

INSTANTIATE_TEST_SUITE_P(Breaths, CarriedOrgans, testing::Values("quiet", "deep"),
                         [](const auto& breath) { return std::string(breath.param); });

}  // namespace
}  // namespace phrenic
