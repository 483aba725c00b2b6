// Bodies that slide on surfaces: how deep they sink in, what is kept, what does not touch.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "absl/strings/str_format.h"
#include "tests/compile_text.h"

namespace phrenic {
namespace {

// A floor of 4 m x 4 m at z = 0, facing up; deformable where it has a mass.
std::string Floor(const std::string& role) {
  return "bodies { name: 'floor' mass: 25 role: " + role +
         " grid { columns: 5 rows: 5 origin { x: -2 y: -2 } u { x: 1 } v { y: 1 } } } ";
}

// An octahedron of 0.1 m radius with springs along its edges and rigid diagonals, 6 kg, its middle at height z.
std::string Ball(double z) {
  const auto vertex = [&](double x, double y, double up) {
    return absl::StrFormat(" vertices { x: %g y: %g z: %g }", x, y, z + up);
  };
  return "bodies { name: 'ball' role: ROLE_DEFORMABLE mass: 6 polyhedron {" + vertex(0.1, 0, 0) + vertex(0, 0.1, 0) +
         vertex(-0.1, 0, 0) + vertex(0, -0.1, 0) + vertex(0, 0, 0.1) + vertex(0, 0, -0.1) +
         " edges { a: 0 b: 1 } edges { a: 1 b: 2 } edges { a: 2 b: 3 } edges { a: 3 b: 0 } edges { a: 4 b: 0 } "
         "edges { a: 4 b: 1 } edges { a: 4 b: 2 } edges { a: 4 b: 3 } edges { a: 5 b: 0 } edges { a: 5 b: 1 } "
         "edges { a: 5 b: 2 } edges { a: 5 b: 3 } } } "
         "constraints { rigid_links { body: 'ball' list { links { a: 0 b: 2 } links { a: 1 b: 3 } links { a: 4 b: 5 } "
         "} "
         "} } forces { springs { bodies: 'ball' stiffness: 5000 } } ";
}

const char kGravity[] = "forces { gravity { bodies: 'ball' acceleration { z: -9.81 } } } ";

std::string Sliding(const std::string& more) {
  return "forces { contact { bodies: 'ball' surfaces: 'floor' depth: 0.002 " + more + " } } ";
}

const Force& ContactOf(const Model& model) {
  return **std::find_if(model.forces.begin(), model.forces.end(),
                        [](const auto& force) { return force->name() == "contact:ball"; });
}

// Of the ball, whose vertices come last [m].
double Deepest(const State& state) { return -state.x.rightCols(6).row(2).minCoeff(); }

State Settle(const Model& model, double seconds) {
  const double dt = model.parameters.time_step();
  return RunTo(model, std::round(seconds / dt) * dt, dt);
}

TEST(Contact, ABallOnAFloorStaysWithinTheStatedDepth) {
  const auto model = CompileText("name: 'rest' " + Floor("ROLE_AT_REST") + Ball(0.101) + kGravity + Sliding("") +
                                 "forces { friction { bodies: 'ball' rate: 5 } } ");
  const State state = Settle(*model, 5);
  EXPECT_GT(Deepest(state), 0) << "it rests on the floor";
  EXPECT_LE(Deepest(state), 0.002 * (1 + 1e-6));
}

// Whatever presses, one vertex sinks in by force over load times the depth.
// It stands on one vertex: friction takes the sinking's motion long before a rounding has tipped it over.
TEST(Contact, ABallPressedWithItsLoadSinksToTheDepth) {
  const auto model = CompileText("name: 'pressed' " + Floor("ROLE_AT_REST") + Ball(0.1) + Sliding("load: 300") +
                                 "forces { friction { bodies: 'ball' rate: 100 } } forces { gravity { bodies: 'ball' "
                                 "acceleration { z: -50 } } } ");
  const State state = Settle(*model, 1);
  EXPECT_NEAR(Deepest(state), 0.002, 0.002 * 1e-3);
}

struct Bounce {
  double highest = 0, deepest = 0;  // the ball's middle, its lowest vertex [m]
};

Bounce LetFall(double part_of_step) {
  const auto model =
      CompileText("name: 'bounce' " + Floor("ROLE_AT_REST") + Ball(0.15) + kGravity + Sliding("load: 3e4"));
  State state = model->InitialState();
  Workspace work = model->MakeWorkspace();
  Bounce bounce;
  while (state.time < 0.3) {
    EXPECT_TRUE(Step(*model, model->parameters, part_of_step * model->parameters.time_step(), state, work).ok());
    bounce.deepest = std::max(bounce.deepest, Deepest(state));
    if (state.time > 0.15) bounce.highest = std::max(bounce.highest, state.x.row(2).mean());
  }
  return bounce;
}

// What it loses shakes its springs.
TEST(Contact, ABouncingBallGainsNothing) {
  const Bounce fine = LetFall(0.05);
  EXPECT_GT(fine.deepest, 0);
  EXPECT_LE(fine.deepest, 0.002);
  EXPECT_LE(fine.highest, 0.15 * 1.001);
  EXPECT_GT(fine.highest, 0.12);
}

// It is told of the floor before the ball is on it.
TEST(Contact, TheChosenStepIsStableOnTheFloor) {
  const Bounce coarse = LetFall(1);
  EXPECT_LE(coarse.deepest, 0.004);
  EXPECT_LT(coarse.highest, 0.2);
}

TEST(Contact, SlidesWithoutFriction) {
  const auto model = CompileText("name: 'slide' " + Floor("ROLE_AT_REST") + Ball(0.0995) + kGravity + Sliding(""));
  State state = model->InitialState();
  state.v.row(0).setConstant(0.5);
  Workspace work = model->MakeWorkspace();
  while (state.time < 1) {
    ASSERT_TRUE(Step(*model, model->parameters, model->parameters.time_step(), state, work).ok());
  }
  EXPECT_NEAR(state.v.row(0).mean(), 0.5, 1e-9);
  EXPECT_NEAR(state.v.row(1).mean(), 0, 1e-9);
}

// On a floor of springs, with every vertex out of place.
class SoftContact : public testing::Test {
 protected:
  void SetUp() override {
    model_ = CompileText("name: 'soft' " + Floor("ROLE_DEFORMABLE") + Ball(0.05) +
                         "forces { contact { bodies: 'ball' surfaces: 'floor' depth: 0.1 } } ");
    ASSERT_NE(model_, nullptr);
    state_ = model_->InitialState();
    std::mt19937 random(11);
    std::uniform_real_distribution<double> shift(-0.04, 0.04);
    for (double& value : state_.x.reshaped()) value += shift(random);
  }
  EvalContext At(const State& state) const { return MakeEvalContext(*model_, model_->parameters, state); }
  Points ForceAt(const State& state) const {
    Points f = Points::Zero(3, state.x.cols());
    ContactOf(*model_).AddForce(At(state), f);
    return f;
  }
  std::shared_ptr<const Model> model_;
  State state_;
};

TEST_F(SoftContact, IsMinusTheEnergysGradientAndKeepsMomentum) {
  const Points f = ForceAt(state_);
  EXPECT_GT(f.row(2).rightCols(6).maxCoeff(), 0.1) << "the ball is pushed up";
  EXPECT_LT(f.row(2).leftCols(25).minCoeff(), -0.01) << "and the floor down";
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < f.cols(); ++i) {
    torque += Eigen::Vector3d(state_.x.col(i)).cross(Eigen::Vector3d(f.col(i)));
  }
  EXPECT_LT(f.rowwise().sum().norm(), 1e-12);
  EXPECT_LT(torque.norm(), 1e-12);
  for (Eigen::Index i = 0; i < state_.x.size(); ++i) {
    constexpr double kStep = 1e-6;
    State low = state_, high = state_;
    low.x.data()[i] -= kStep, high.x.data()[i] += kStep;
    const double slope = (ContactOf(*model_).Energy(At(high)) - ContactOf(*model_).Energy(At(low))) / (2 * kStep);
    EXPECT_NEAR(f.data()[i], -slope, 1e-5);
  }
}

TEST_F(SoftContact, TurnsWithTheScene) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  State moved = state_;
  moved.x = (turn * state_.x).colwise() + Eigen::Vector3d(1, 2, 3);
  EXPECT_LT((ForceAt(moved) - turn * ForceAt(state_)).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Contact, NothingTouchesInFrontBesideOrBeyondTenDepths) {
  const auto model = CompileText("name: 'apart' " + Floor("ROLE_AT_REST") + Ball(1) + Sliding(""));
  State state = model->InitialState();
  const auto largest = [&](const Eigen::Vector3d& shift) {
    state.x = model->rest.colwise() + shift;
    Points f = Points::Zero(3, 6);
    ContactOf(*model).AddForce(MakeEvalContext(*model, model->parameters, state), f);
    return f.cwiseAbs().maxCoeff();
  };
  EXPECT_EQ(largest({0, 0, 0}), 0);
  EXPECT_GT(largest({0, 0, -0.901}), 0);
  EXPECT_EQ(largest({2.11, 0, -1.0005}), 0) << "beyond the border";
  EXPECT_EQ(largest({0, 0, -1.2}), 0) << "it has got through";
}

// A floor carried by a pose pushes as the same floor at rest does, turned with it.
TEST(Contact, ADrivenSurfacePushesWhereItsPoseHasIt) {
  const auto model = CompileText(
      "name: 'driven' " + Ball(0.0995) + Sliding("") +
      "bodies { name: 'floor' role: ROLE_DRIVEN anatomy { structure: STRUCTURE_RIB number: 7 side: SIDE_LEFT } "
      "polyhedron { vertices { x: -9 y: -9 } vertices { x: 20 y: -9 } vertices { y: 20 } triangles { a: 0 b: 1 c: 2 } "
      "} } "
      "motions { ribs { bodies: 'floor' end_states { number: 7 pump_degrees: 10 } } } ");
  State state = model->InitialState();
  const auto force = [&] {
    Points f = Points::Zero(3, 6);
    ContactOf(*model).AddForce(MakeEvalContext(*model, model->parameters, state), f);
    return f;
  };
  state.poses.front() = Pose{};
  const Points at_rest = force();
  EXPECT_GT(at_rest(2, 5), 1);
  Pose& pose = state.poses.front();
  pose.rotation = Eigen::AngleAxisd(0.8, Eigen::Vector3d(1, 2, -1).normalized());
  pose.translation = Eigen::Vector3d(0.3, -0.2, 5);
  for (auto x : state.x.colwise()) x = pose.At(x);
  EXPECT_LT((force() - pose.rotation.toRotationMatrix() * at_rest).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Contact, RefusesWhatCannotBeASurface) {
  const std::string scene = "name: 'wrong' " + Ball(1) +
                            "bodies { name: 'floor' role: ROLE_AT_REST polyhedron { "
                            "vertices {} } } ";
  const auto none = TryCompileText(scene + Sliding(""));
  EXPECT_NE(none.status().message().find("contact.surfaces: body \"floor\" has no triangles"), std::string::npos)
      << none.status();
}

}  // namespace
}  // namespace phrenic
