// The laws that every measure keeps. A new measure joins with one line in kMeasures.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "server/mechanics/measures/readings.h"
#include "server/mechanics/skinning/body_points.h"
#include "server/mesh/topology.h"
#include "tests/compile_text.h"
#include "tests/contract/allocations.h"

namespace phrenic {
namespace {

struct MeasureCase {
  const char* name;
  const char* text;       // one measure of the scene, without its name
  const char* unit;       // and what a number of it grows by when all lengths do, twofold
  double when_twice;      // 0: the law has lengths of its own
  bool moves_with_space;  // a rigid motion of everything changes it
};

const MeasureCase kMeasures[] = {
    {"volume", "volume { surface { bodies: 'ball' } }", "m^3", 8, false},
    {"volume_of_a_driven_body", "volume { surface { bodies: 'piston' } }", "m^3", 8, false},
    {"volume_of_a_riding_body", "volume { surface { bodies: 'passenger' } }", "m^3", 8, false},
    {"volume_of_a_mapped_body", "volume { surface { bodies: 'skin' } }", "m^3", 0, false},
    {"volume_of_two", "volume { surface { bodies: ['ball', 'piston'] } }", "m^3", 8, false},
    {"volume_below", "volume { surface { bodies: 'sheet' } plane { normal { x: 1 z: 2 } } }", "m^3", 8, true},
    {"volume_of_one_face", "volume { surface { bodies: 'ball' facing { z: 1 } } plane {} }", "m^3", 8, true},
    {"volume_from_rest", "volume { surface { bodies: 'ball' } from_rest: true }", "m^3", 0, false},
    {"flow", "flow { surface { bodies: 'ball' } }", "m^3/s", 8, false},
    {"flow_of_several", "flow { surface { bodies: ['ball', 'piston', 'passenger', 'skin', 'layer'] } }", "m^3/s", 0,
     false},
    {"kinetic_energy", "kinetic_energy { bodies: ['ball', 'sheet'] }", "J", 4, false},
    {"elastic_energy", "elastic_energy {}", "J", 0, false},
    {"highest", "highest { body: 'ball' direction { x: 1 z: 3 } }", "m", 2, true},
    {"highest_of_a_driven_body", "highest { body: 'piston' }", "m", 2, true},
    {"highest_of_a_mapped_body", "highest { body: 'skin' }", "m", 0, true},
    {"highest_of_a_layer", "highest { body: 'layer' }", "m", 0, true},
    {"highest_from_rest", "highest { body: 'ball' from_rest: true }", "m", 0, true},
    {"force_output", "force_output { force: 'gas' output: 'volume' }", "m^3", 8, false},
};

void PrintTo(const MeasureCase& measure, std::ostream* out) { *out << measure.name; }

const char kScene[] =
    "name: 'contract' bodies { name: 'ball' role: ROLE_DEFORMABLE mass: 2 ellipsoid { radii { x: 1 y: 1 z: 2 } "
    "divisions: 3 } } bodies { name: 'sheet' role: ROLE_DEFORMABLE grid { columns: 4 rows: 3 origin { z: 2 } "
    "u { x: 1 } v { y: 1 z: 0.2 } } } bodies { name: 'piston' role: ROLE_DRIVEN ellipsoid { centre { x: 4 } "
    "radii { x: 1 y: 2 z: 1 } divisions: 2 } } bodies { name: 'rider' role: ROLE_SEEN ellipsoid { centre { x: 2 } "
    "radii { x: 0.5 y: 0.5 z: 0.5 } divisions: 2 } } bodies { name: 'passenger' role: ROLE_SEEN ellipsoid { centre { "
    "x: 2 } "
    "radii { x: 0.5 y: 0.5 z: 0.5 } divisions: 2 } } motions { skin { bodies: 'rider' drivers: ['ball', 'piston'] } } "
    "motions { skin { bodies: 'passenger' drivers: 'piston' } } "
    "bodies { name: 'skin' role: ROLE_SEEN ellipsoid { radii { x: 1.2 y: 1.2 z: 2.2 } divisions: 4 } } "
    "motions { skin { bodies: 'skin' drivers: 'ball' mode: SKIN_MODE_TRIANGLES } } "
    "bodies { name: 'layer' role: ROLE_SEEN ellipsoid { radii { x: 1.1 y: 1.1 z: 2.1 } divisions: 4 } } "
    "motions { skin { bodies: 'layer' drivers: 'ball' mode: SKIN_MODE_SHEET thickness: 1 } } "
    "forces { springs { bodies: 'ball' } } "
    "forces { name: 'gas' pressure { surface { bodies: 'ball' } pressure: 3 } } ";

// All of it a little later, by its velocities alone.
State Ahead(const State& state, double dt) {
  State ahead = state;
  ahead.x += dt * state.v;
  for (Pose& pose : ahead.poses) {
    const double angle = dt * pose.angular_velocity.norm();
    pose.rotation = Eigen::AngleAxisd(angle, pose.angular_velocity.normalized()) * pose.rotation;
    pose.translation += dt * pose.velocity;
  }
  return ahead;
}

void Shake(State& state) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> shift(-0.1, 0.1);
  for (double& value : state.x.reshaped()) value += shift(random);
  for (double& value : state.v.reshaped()) value = shift(random);
  Pose& pose = state.poses.front();
  pose.rotation = Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, -1).normalized());
  pose.translation = {0.1, -0.2, 0.3};
  pose.angular_velocity = {0.5, -0.4, 0.3};
  pose.velocity = {-0.2, 0.1, 0.4};
}

int IndexOf(const Model& model, const std::string& body) {
  const auto found =
      std::find_if(model.bodies.begin(), model.bodies.end(), [&](const BodyModel& of) { return of.name == body; });
  return static_cast<int>(found - model.bodies.begin());
}

class MeasureContract : public testing::TestWithParam<MeasureCase> {
 protected:
  void SetUp() override {
    model_ = CompileText(std::string(kScene) + "measures { name: 'it' " + GetParam().text + " }");
    ASSERT_NE(model_, nullptr);
    ASSERT_EQ(model_->measures.size(), 1u);
    state_ = Somewhere(*model_);
  }

  static State Somewhere(const Model& model) {
    State state = model.InitialState();
    Shake(state);
    return state;
  }
  static double ValueAt(const Model& model, const State& state) {
    return model.measures.front()->Value(MakeEvalContext(model, model.parameters, state));
  }

  std::shared_ptr<const Model> model_;
  State state_;
};

TEST_P(MeasureContract, HasNameUnitAndReading) {
  const MeasureReadings readings = ReadMeasures(*model_, MakeEvalContext(*model_, model_->parameters, state_));
  ASSERT_EQ(readings.size(), 1);
  EXPECT_EQ(readings[0].name(), "it");
  EXPECT_EQ(readings[0].unit(), GetParam().unit);
  EXPECT_EQ(readings[0].value(), ValueAt(*model_, state_));
  EXPECT_TRUE(std::isfinite(readings[0].value()));
  EXPECT_NE(readings[0].value(), 0);
}

TEST_P(MeasureContract, IsReportedByTheCompileStep) {
  const auto& elements = model_->report.elements();
  EXPECT_TRUE(std::any_of(elements.begin(), elements.end(),
                          [](const auto& row) { return row.family() == "measure" && row.name() == "it"; }));
}

// A volume grows eightfold when all lengths and velocities double: the number is in the unit's dimension.
TEST_P(MeasureContract, GrowsAsItsUnitSays) {
  if (GetParam().when_twice == 0) GTEST_SKIP() << "counts from a length of the scene";
  State twice = state_;
  twice.x *= 2, twice.v *= 2;
  const double once = ValueAt(*model_, state_);
  // What is carried cannot grow: its share is that of the same state, seen alone.
  State carried = state_;
  carried.x.setZero(), carried.v.setZero();
  if (ValueAt(*model_, carried) != 0) GTEST_SKIP() << "of a rigid body";
  EXPECT_NEAR(ValueAt(*model_, twice), GetParam().when_twice * once, 1e-9 * std::abs(once));
}

TEST_P(MeasureContract, RigidMotionChangesItOnlyWhereItHasAPlace) {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 3).normalized()));
  const Eigen::Vector3d shift(0.4, -0.5, 0.6);
  State moved = state_;
  moved.x = (turn.toRotationMatrix() * state_.x).colwise() + shift;
  moved.v = turn.toRotationMatrix() * state_.v;
  for (Pose& pose : moved.poses) {
    pose.rotation = turn * pose.rotation;
    pose.translation = turn * pose.translation + shift;
    pose.angular_velocity = turn * pose.angular_velocity;
    pose.velocity = turn * pose.velocity;
  }
  const double before = ValueAt(*model_, state_), after = ValueAt(*model_, moved);
  if (GetParam().moves_with_space) {
    EXPECT_GT(std::abs(after - before), 1e-3);
  } else {
    EXPECT_NEAR(after, before, 1e-9 * (1 + std::abs(before)));
  }
}

TEST_P(MeasureContract, AllocatesNothing) {
  const EvalContext at = MakeEvalContext(*model_, model_->parameters, state_);
  const Measure& measure = *model_->measures.front();
  const double value = measure.Value(at);
  const std::int64_t before = Allocations();
  EXPECT_EQ(measure.Value(at), value);
  EXPECT_EQ(Allocations(), before);
}

INSTANTIATE_TEST_SUITE_P(Measures, MeasureContract, testing::ValuesIn(kMeasures),
                         [](const auto& test) { return std::string(test.param.name); });

// What measures share changes none of them, whichever comes first.
TEST(ReadMeasuresContract, TellsInTheScenesOrderWhatEachTellsAlone) {
  const char* const kinds[] = {"volume { surface { bodies: 'ball' } }",
                               "flow { surface { bodies: 'ball' } }",
                               "volume { surface { bodies: 'ball' } from_rest: true }",
                               "force_output { force: 'gas' output: 'volume' }",
                               "volume { surface { bodies: 'rider' } }",
                               "flow { surface { bodies: 'skin' } }"};
  std::string text = kScene;
  for (int i = 0; i < 12; ++i) text += "measures { name: '" + std::to_string(i) + "' " + kinds[5 * i % 6] + " } ";
  const auto model = CompileText(text);
  ASSERT_NE(model, nullptr);
  State state = model->InitialState();
  Shake(state);
  const EvalContext at = MakeEvalContext(*model, model->parameters, state);
  const MeasureReadings readings = ReadMeasures(*model, at);
  ASSERT_EQ(readings.size(), 12);
  for (int i = 0; i < readings.size(); ++i) {
    EXPECT_EQ(readings[i].name(), std::to_string(i));
    EXPECT_EQ(readings[i].value(), model->measures[i]->Value(at)) << i;
  }
}

// On every kind of body, what is measured is what is seen.
TEST(VolumeContract, IsThatOfTheSurfaceWherePeopleSeeIt) {
  for (const std::string body : {"ball", "piston", "rider", "passenger", "skin"}) {
    const auto model =
        CompileText(std::string(kScene) + "measures { name: 'v' volume { surface { bodies: '" + body + "' } } }");
    ASSERT_NE(model, nullptr);
    State state = model->InitialState();
    Shake(state);
    const int index = IndexOf(*model, body);
    const Mesh& mesh = model->bodies[index].mesh;
    Points seen(3, mesh.vertices.cols());
    PlaceBody(*model, state, index, seen);
    EXPECT_GT((seen - mesh.vertices).cwiseAbs().maxCoeff(), 0.01) << body;
    const double measured = model->measures.front()->Value(MakeEvalContext(*model, model->parameters, state));
    EXPECT_NEAR(measured, SignedVolume(seen, mesh.triangles), 1e-12) << body;
  }
}

// On every kind of body, closed and open: flow is the derivative of the volume of the same surface.
TEST(FlowContract, IsTheRateOfTheVolume) {
  const char* const surfaces[] = {"surface { bodies: 'ball' }",
                                  "surface { bodies: 'piston' }",
                                  "surface { bodies: 'rider' }",
                                  "surface { bodies: 'skin' }",
                                  "surface { bodies: 'sheet' } plane { point { x: 1 } normal { x: 1 z: 2 } }",
                                  "surface { bodies: ['ball', 'piston', 'rider', 'skin'] facing { z: 1 } }"};
  for (const std::string surface : surfaces) {
    const auto model = CompileText(std::string(kScene) + "measures { name: 'v' volume { " + surface +
                                   " } } measures { name: 'f' flow { " + surface + " } }");
    ASSERT_NE(model, nullptr);
    State state = model->InitialState();
    std::mt19937 random(5);
    std::uniform_real_distribution<double> value(-0.3, 0.3);
    for (double& v : state.v.reshaped()) v = value(random);
    state.poses.front().angular_velocity = {0.5, -0.4, 0.3};
    state.poses.front().velocity = {-0.2, 0.1, 0.4};
    constexpr double kStep = 1e-5;
    const auto read = [&](int measure, const State& at) {
      return model->measures[measure]->Value(MakeEvalContext(*model, model->parameters, at));
    };
    const double difference = (read(0, Ahead(state, kStep)) - read(0, Ahead(state, -kStep))) / (2 * kStep);
    EXPECT_NEAR(read(1, state), difference, 1e-8) << surface;
  }
}

}  // namespace
}  // namespace phrenic
