// Ribs, sternum and what rides on them, on bones made of a few vertices.
#include <gtest/gtest.h>

#include <numbers>

#include "server/mechanics/skinning/body_points.h"
#include "tests/compile_text.h"

namespace phrenic {
namespace {

// Seven rib pairs as rods from the head (20 mm from the midplane) outwards and forwards, and a sternum in front.
std::string Thorax() {
  std::string text = "name: 'bones' breath { waveform: WAVEFORM_RAISED_COSINE } ";
  std::string ends;
  for (int n = 1; n <= 7; ++n) {
    const std::string z = std::to_string(-0.02 * n), low = std::to_string(-0.02 * n - 0.06);
    for (const int side : {-1, 1}) {
      const auto x = [&](double value) { return std::to_string(side * value); };
      text += "bodies { name: 'rib-" + std::to_string(n) + (side < 0 ? "-r" : "-l") +
              "' layer: 'ribs' role: ROLE_DRIVEN anatomy { structure: STRUCTURE_RIB number: " + std::to_string(n) +
              (side < 0 ? " side: SIDE_RIGHT" : " side: SIDE_LEFT") + " } polyhedron { vertices { x: " + x(0.02) +
              " z: " + z + " } vertices { x: " + x(0.12) + " y: -0.1 z: " + z + " } vertices { x: " + x(0.06) +
              " y: -0.18 z: " + low + " } } } ";
    }
    ends += "end_states { number: " + std::to_string(n) + " pump_degrees: 10 bucket_degrees: 12 } ";
  }
  return text +
         "bodies { name: 'sternum' role: ROLE_DRIVEN polyhedron { vertices { y: -0.18 z: -0.1 } vertices { x: 0.01 y: "
         "-0.18 z: -0.15 } } } bodies { name: 'cartilage' role: ROLE_SEEN polyhedron { vertices { x: -0.06 y: -0.18 z: "
         "-0.08 } vertices { x: -0.03 y: -0.18 z: -0.09 } vertices { y: -0.18 z: -0.1 } } } "
         "motions { ribs { bodies: 'ribs' quiet_state: 1 " +
         ends +
         "} } motions { sternum { bodies: 'sternum' ribs: 'ribs' } } "
         "motions { skin { bodies: 'cartilage' drivers: ['rib-1-r', 'sternum'] } } ";
}

State AtPeak(const Model& model) { return RunTo(model, 2.0, 1e-3); }  // half of the 4 s breath

Points Placed(const Model& model, const State& state, const std::string& name) {
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    if (model.bodies[b].name != name) continue;
    Points out(3, model.bodies[b].mesh.vertices.cols());
    PlaceBody(model, state, b, out);
    return out;
  }
  ADD_FAILURE() << "no body " << name;
  return {};
}

TEST(Ribs, TurnUnderEveryIntegratorAlsoWhereNothingIsDeformable) {
  const State usual = RunTo(*CompileText(Thorax()), 2, 0.1);
  const auto& kinds = *v1::Integrator_descriptor();
  for (int i = 0; i < kinds.value_count(); ++i) {
    const auto model = CompileText(Thorax() + "parameters { integrator: " + kinds.value(i)->name() + " }");
    const State state = RunTo(*model, 2, 0.1);
    EXPECT_EQ(Placed(*model, state, "rib-3-r"), Placed(*model, usual, "rib-3-r")) << kinds.value(i)->name();
  }
}

TEST(Ribs, TurnByTheirEndStateAboutTheirHeads) {
  const auto model = CompileText(Thorax());
  const State state = AtPeak(*model);
  const Points right = Placed(*model, state, "rib-3-r");
  EXPECT_LT((right.col(0) - Eigen::Vector3d(-0.02, 0, -0.06)).norm(), 1e-9) << "the head stays";
  const Eigen::Vector3d turn = Eigen::Vector3d(-10, 12, 0) * std::numbers::pi / 180;
  const Eigen::Vector3d arm(-0.1, -0.1, 0);
  const Eigen::Vector3d exact =
      Eigen::Vector3d(-0.02, 0, -0.06) + Eigen::AngleAxisd(turn.norm(), turn.normalized()) * arm;
  EXPECT_LT((right.col(1) - exact).norm(), 1e-6);
}

TEST(Ribs, LeftIsTheMirrorImageOfRight) {
  const auto model = CompileText(Thorax());
  const State state = AtPeak(*model);
  Points left = Placed(*model, state, "rib-5-l");
  left.row(0) *= -1;
  EXPECT_LT((left - Placed(*model, state, "rib-5-r")).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Ribs, RiseForwardAndOutward) {
  const auto model = CompileText(Thorax());
  const Points moved = Placed(*model, AtPeak(*model), "rib-4-r"), rest = model->bodies[6].mesh.vertices;
  ASSERT_EQ(model->bodies[6].name, "rib-4-r");
  EXPECT_GT(moved(2, 2), rest(2, 2)) << "up";
  EXPECT_LT(moved(1, 2), rest(1, 2)) << "forward";
  EXPECT_LT(moved(0, 2), rest(0, 2)) << "outward";
}

TEST(Ribs, VelocityIsTheRateOfThePosition) {
  const auto model = CompileText(Thorax() + "parameters { hyperinflation: 0.3 }");
  const State early = RunTo(*model, 0.999, 1e-3), middle = RunTo(*model, 1.0, 1e-3), late = RunTo(*model, 1.001, 1e-3);
  for (size_t p = 0; p < middle.poses.size(); ++p) {
    const Eigen::Vector3d point(-0.06, -0.18, -0.1);
    const Eigen::Vector3d rate = (late.poses[p].At(point) - early.poses[p].At(point)) / 2e-3;
    EXPECT_LT((middle.poses[p].VelocityAt(point) - rate).norm(), 2e-3 * rate.norm() + 1e-6) << "pose " << p;
  }
}

TEST(Ribs, WholeHandlesChangeNoBit) {
  const auto model = CompileText(Thorax() + "parameters { pump_handle: 1 bucket_handle: 1 }");
  const State state = RunTo(*model, 1.3, 1e-3);
  const double k = MakeEvalContext(*model, model->parameters, state).breath;
  const Eigen::Vector3d turn = Eigen::Vector3d(-10, 12, 0) * (std::numbers::pi / 180);
  const Eigen::Quaterniond whole(Eigen::AngleAxisd(k * turn.norm(), Eigen::Vector3d(turn / turn.norm())));
  ASSERT_EQ(model->bodies[4].name, "rib-3-r");
  EXPECT_EQ(state.poses[model->bodies[4].pose].rotation.coeffs(), whole.coeffs());
}

// The test's quiet breath goes all the way.
TEST(Ribs, OfFullLungsStartHighAndPassTotalCapacityNever) {
  const auto empty = CompileText(Thorax()), full = CompileText(Thorax() + "parameters { hyperinflation: 0.4 }");
  const auto turned = [](const Model& model, double time) {
    const State state = RunTo(model, time, 1e-3);
    return Eigen::AngleAxisd(state.poses[model.bodies[4].pose].rotation).angle();
  };
  const double whole = turned(*empty, 2);
  EXPECT_NEAR(turned(*full, 4), 0.4 * whole, 1e-4 * whole);
  EXPECT_NEAR(turned(*full, 2), whole, 1e-9);
  EXPECT_NEAR(turned(*CompileText(Thorax() + "parameters { hyperinflation: 2 }"), 1), whole, 1e-9);
}

TEST(Ribs, WithoutHandlesRest) {
  const auto model = CompileText(Thorax() + "parameters { pump_handle: 0 bucket_handle: 0 }");
  const State state = AtPeak(*model);
  for (const char* name : {"rib-1-r", "rib-7-l", "sternum", "cartilage"}) {
    const Points moved = Placed(*model, state, name);
    const Points rest = Placed(*model, model->InitialState(), name);
    EXPECT_LT((moved - rest).cwiseAbs().maxCoeff(), 1e-15) << name;
  }
  for (const Pose& pose : state.poses) EXPECT_EQ(pose.angular_velocity.norm() + pose.velocity.norm(), 0);
}

// A handle alone turns the rib about its own axis, by twice as much where it is doubled.
TEST(Ribs, EachHandleTurnsAboutItsOwnAxis) {
  const Eigen::Vector3d head(-0.02, 0, -0.06);
  const auto end = [&head](double pump, double bucket) {
    const auto model = CompileText(Thorax() + "parameters { pump_handle: " + std::to_string(pump) +
                                   " bucket_handle: " + std::to_string(bucket) + " }");
    return Eigen::Vector3d(Placed(*model, AtPeak(*model), "rib-3-r").col(1) - head);
  };
  const auto turned = [](double degrees, const Eigen::Vector3d& axis) {
    return Eigen::Vector3d(Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis) * Eigen::Vector3d(-0.1, -0.1, 0));
  };
  EXPECT_LT((end(1, 0) - turned(-10, Eigen::Vector3d::UnitX())).norm(), 1e-6);
  EXPECT_LT((end(0, 1) - turned(12, Eigen::Vector3d::UnitY())).norm(), 1e-6);
  EXPECT_LT((end(2, 0) - turned(-20, Eigen::Vector3d::UnitX())).norm(), 1e-6);
}

TEST(Sternum, FollowsEachHandleWithoutSidewaysDrift) {
  for (const char* handles : {"pump_handle: 2 bucket_handle: 0", "pump_handle: 0 bucket_handle: 2"}) {
    const auto model = CompileText(Thorax() + "parameters { " + handles + " }");
    const State state = AtPeak(*model);
    const Points sternum = Placed(*model, state, "sternum"), cartilage = Placed(*model, state, "cartilage");
    EXPECT_NEAR(sternum(0, 0), 0, 1e-12) << handles;
    EXPECT_NEAR(sternum(0, 1), 0.01, 1e-12) << handles;
    EXPECT_GT(sternum(2, 0), -0.1 + 1e-3) << handles << ": the ribs' ends rise";
    EXPECT_LT((cartilage.col(0) - Placed(*model, state, "rib-1-r").col(2)).norm(), 1e-3) << handles;
    EXPECT_LT((cartilage.col(2) - sternum.col(0)).norm(), 1e-3) << handles;
  }
}

TEST(Sternum, FollowsTheRibsWithoutSidewaysDrift) {
  const auto model = CompileText(Thorax());
  const Points moved = Placed(*model, AtPeak(*model), "sternum");
  EXPECT_NEAR(moved(0, 0), 0, 1e-12);
  EXPECT_NEAR(moved(0, 1), 0.01, 1e-12);
  EXPECT_GT(moved(2, 0), -0.1);
  EXPECT_LT(moved(1, 0), -0.18);
}

TEST(Skin, JoinsItsCarriersAtItsEnds) {
  const auto model = CompileText(Thorax());
  const State state = AtPeak(*model);
  const Points cartilage = Placed(*model, state, "cartilage");
  EXPECT_LT((cartilage.col(0) - Placed(*model, state, "rib-1-r").col(2)).norm(), 1e-3);
  EXPECT_LT((cartilage.col(2) - Placed(*model, state, "sternum").col(0)).norm(), 1e-3);
}

TEST(Breath, SignalIsContinuousWhenItsLengthChanges) {
  const auto model = CompileText(Thorax());
  State state = RunTo(*model, 1.3, 1e-3);
  Workspace work = model->MakeWorkspace();
  v1::Parameters slower = model->parameters;
  slower.set_breath_length(9);
  const double before = MakeEvalContext(*model, model->parameters, state).breath;
  ASSERT_TRUE(Step(*model, slower, 1e-3, state, work).ok());
  EXPECT_NEAR(MakeEvalContext(*model, slower, state).breath, before, 1e-3);
}

}  // namespace
}  // namespace phrenic
