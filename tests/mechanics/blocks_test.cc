// What is evaluated block by block gives the bits of the whole, on every instruction set that this machine has.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "absl/strings/str_cat.h"
#include "server/mechanics/forces/attachment_kernel.h"
#include "server/mechanics/forces/spring_kernel.h"
#include "server/mechanics/linalg/vertex_kernel.h"
#include "server/mechanics/step/step_plan.h"
#include "tests/compile_text.h"
#include "tests/mechanics/every_target.h"
#include "tests/mechanics/mixed_sheet.h"

namespace phrenic {
namespace {

// In the midst of a breath, all vertices off their places and moving.
State Disturbed(const Model& model) {
  State state = model.InitialState();
  state.phase = 0.3;
  state.x += 0.002 * Points::Random(3, state.x.cols());
  state.v = Points::Random(3, state.x.cols());
  return state;
}

// All that a step evaluates block by block.
std::vector<const BlockForce*> BlockForcesOf(const Model& model) {
  const ForceSchedule& schedule = model.plan->schedule();
  std::vector<const BlockForce*> forces = schedule.by_block;
  if (schedule.loads != nullptr) forces.push_back(schedule.loads);
  return forces;
}

TEST(Ranges, GiveEachForceTheBitsOfTheWhole) {
  const auto model = CompileText(kMixedSheet);
  ASSERT_NE(model, nullptr);
  const State state = Disturbed(*model);
  ASSERT_GT(state.x.cols(), 2 * kVertexBlock);
  Workspace work = model->MakeWorkspace();
  const BlockContext at = model->plan->PrepareBlocks(model->parameters, state, work);
  ASSERT_TRUE(model->plan->schedule().whole.empty());
  for (const BlockForce* force : BlockForcesOf(*model)) {
    Points whole = Points::Zero(3, state.x.cols()), parts = whole;
    force->AddForce(at, whole);
    ForEachBlock({0, state.x.cols()}, [&](const VertexRange& block) {
      const Eigen::Index vertices = block.end - block.first;
      Points guarded = Points::Zero(3, vertices + 2);  // a column before the range's own, and one after
      force->AddForceToBlock(block, at, guarded.middleCols(1, vertices));
      parts.middleCols(block.first, vertices) = guarded.middleCols(1, vertices);
      EXPECT_EQ(guarded.col(0).norm() + guarded.col(vertices + 1).norm(), 0)
          << force->name() << " reaches beyond its range";
    });
    EXPECT_EQ(parts, whole) << force->name();
    EXPECT_GT(whole.norm(), 0) << force->name();
  }
}

TEST(Ranges, ReadNoPlacesOfOthersUnlessTheySaySo) {
  const auto model = CompileText(kMixedSheet);
  ASSERT_NE(model, nullptr);
  const State state = Disturbed(*model);
  Workspace work = model->MakeWorkspace();
  const BlockContext at = model->plan->PrepareBlocks(model->parameters, state, work);
  int readers = 0;
  for (const BlockForce* force : BlockForcesOf(*model)) {
    bool read = false;
    ForEachBlock({0, state.x.cols()}, [&](const VertexRange& block) {
      const Eigen::Index vertices = block.end - block.first;
      State others = state;
      others.x.setConstant(7);
      others.x.middleCols(block.first, vertices) = state.x.middleCols(block.first, vertices);
      BlockContext moved{MakeEvalContext(*model, model->parameters, others)};
      moved.packed = at.packed;
      moved.pose_matrices = at.pose_matrices;
      Points here = Points::Zero(3, vertices), there = here;
      force->AddForceToBlock(block, at, here);
      force->AddForceToBlock(block, moved, there);
      read = read || here != there;
    });
    EXPECT_EQ(read, force->reads_neighbours()) << force->name();
    readers += force->reads_neighbours();
  }
  EXPECT_EQ(readers, 1) << "the springs in double precision alone";
}

// Whatever is worked out together: five shared forces are more than the kernel takes at a time.
TEST(Ranges, SumWhatTheElementsSayOneByOne) {
  std::string scene = kMixedSheet;
  for (const char* axis : {"x", "y", "z"}) {
    absl::StrAppend(&scene, "forces { gravity { bodies: 'sheet' acceleration { ", axis, ": 3 } } }");
  }
  absl::StrAppend(&scene, "forces { friction { bodies: 'sheet' rate: 2 } }");
  const auto model = CompileText(scene);
  ASSERT_NE(model, nullptr);
  const State state = Disturbed(*model);
  const EvalContext at = MakeEvalContext(*model, model->parameters, state);
  Points apart = Points::Zero(3, state.x.cols()), together = apart;
  for (const auto& force : model->forces) force->AddForce(at, apart);
  model->plan->SumForces(at, together);
  EXPECT_LT((together - apart).cwiseAbs().maxCoeff(), 1e-5 * apart.cwiseAbs().maxCoeff());
  EXPECT_LT(BlockForcesOf(*model).size(), model->forces.size() - 4);
}

TEST(Ranges, SetTheForceThatTheyWouldAddToNothingOnEveryInstructionSet) {
  const auto model = CompileText(kMixedSheet);
  ASSERT_NE(model, nullptr);
  const State state = Disturbed(*model);
  OnEveryTarget([&] {
    Workspace work = model->MakeWorkspace();
    const BlockContext at = model->plan->PrepareBlocks(model->parameters, state, work);
    for (const BlockForce* force : BlockForcesOf(*model)) {
      ForEachBlock({0, state.x.cols()}, [&](const VertexRange& block) {
        Points added = Points::Zero(3, block.end - block.first);
        Points set = Points::Constant(3, block.end - block.first, std::nan(""));
        force->AddForceToBlock(block, at, added);
        force->SetForceOnBlock(block, at, set);
        EXPECT_EQ(set, added) << force->name() << " from vertex " << block.first;
      });
    }
  });
}

void ExpectReach(const StateBounds& reach, double furthest, double fastest) {
  EXPECT_THAT(reach.furthest, testing::NanSensitiveDoubleEq(furthest));
  EXPECT_THAT(reach.fastest, testing::NanSensitiveDoubleEq(fastest));
}

// Found by itself, and while vertices move: with neither time they stay, whatever is no number.
TEST(Ranges, ReachAsCoordinateByCoordinateOnEveryInstructionSet) {
  const VertexRange range{8, 45};
  Points x = Points::Random(3, 45), v = Points::Random(3, 45);
  x.col(7).setConstant(9), v.col(7).setConstant(9);  // beside the range
  const Points f = Points::Zero(3, range.end - range.first);
  const Eigen::VectorXd w = Eigen::VectorXd::Zero(45);
  const auto largest = [&](const Points& of) {
    return of.rightCols(range.end - range.first).cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
  };
  const auto expect = [&](Points& there, Points& speed) {
    OnEveryTarget([&] {
      ExpectReach(BoundsOf(range, there, speed), largest(there), largest(speed));
      ExpectReach(KickAndDrift(range, w, 0, 0, f, {}, there, speed, there, speed), largest(there), largest(speed));
    });
  };
  expect(x, v);
  for (const double one : {-3.0, std::numeric_limits<double>::infinity(), std::nan("")}) {
    for (const Eigen::Index vertex : {8, 20, 44}) {
      for (Points* const of : {&x, &v}) {
        const double before = (*of)(1, vertex);
        (*of)(1, vertex) = one;
        expect(x, v);
        (*of)(1, vertex) = before;
      }
    }
  }
}

// With friction and without, as many shared forces as there may be, and none.
struct LoadsOfEveryNumber {
  explicit LoadsOfEveryNumber(Eigen::Index vertices) : numbers(Eigen::MatrixXd::Random(vertices, 5)) {
    for (const bool rubs : {false, true}) {
      VertexLoads loads;
      if (rubs) loads.c = numbers.col(4).data();
      of.push_back(loads);
      for (Eigen::Index l = 0; l < 4; ++l) {
        loads.shared[loads.count++] = {numbers.col(l).data(), Eigen::Vector3d::Random()};
        of.push_back(loads);
      }
    }
  }
  Eigen::MatrixXd numbers;
  std::vector<VertexLoads> of;
};

Eigen::Vector3d Loaded(Eigen::Vector3d f, const VertexLoads& loads, Eigen::Index vertex, const Eigen::Vector3d& v) {
  if (loads.c != nullptr) f -= loads.c[vertex] * v;
  for (size_t l = 0; l < loads.count; ++l) f += loads.shared[l].weight[vertex] * loads.shared[l].force;
  return f;
}

TEST(Ranges, KickAndDriftAsVertexByVertexOnEveryInstructionSet) {
  const VertexRange range{8, 45};
  const LoadsOfEveryNumber all(range.end);
  const Points f = Points::Random(3, range.end), x = Points::Random(3, range.end), v = Points::Random(3, range.end);
  Eigen::VectorXd w = Eigen::VectorXd::Random(range.end).cwiseMax(0);  // about half of them fixed
  for (const VertexLoads& loads : all.of) {
    Points v_plain = v, x_plain = x;
    for (Eigen::Index i = range.first; i < range.end; ++i) {
      if (w[i] == 0) continue;
      v_plain.col(i) += 0.3 * w[i] * Loaded(f.col(i), loads, i, v.col(i));
      x_plain.col(i) += 0.7 * v_plain.col(i);
    }
    OnEveryTarget([&] {
      Points v_here = v, x_here = x;
      const auto own = f.middleCols(range.first, range.end - range.first);
      const StateBounds reach = KickAndDrift(range, w, 0.3, 0.7, own, loads, x, v_here, x_here, v_here);
      EXPECT_EQ(reach.furthest, x_here.middleCols(range.first, own.cols()).cwiseAbs().maxCoeff());
      EXPECT_EQ(reach.fastest, v_here.middleCols(range.first, own.cols()).cwiseAbs().maxCoeff());
      EXPECT_EQ(v_here, v_plain);
      EXPECT_EQ(x_here, x_plain);
    });
  }
}

TEST(Ranges, PackPointsAsVertexByVertexOnEveryInstructionSet) {
  struct alignas(64) Packed {
    float at[4 * 45] = {};
  };
  const VertexRange range{8, 45};
  const Points x = Points::Random(3, range.end + 1);
  const Eigen::Vector3d origin = Eigen::Vector3d::Random();
  OnEveryTarget([&] {
    Packed packed;
    PackPoints(range, x.data(), origin.data(), packed.at);
    for (Eigen::Index v = 0; v < range.end; ++v) {
      for (int c = 0; c < 3; ++c) {
        EXPECT_EQ(packed.at[4 * v + c], v < range.first ? 0 : static_cast<float>(x(c, v) - origin[c])) << v;
      }
    }
  });
}

TEST(Ranges, LoadsAsVertexByVertexOnEveryInstructionSet) {
  const VertexRange range{8, 45};
  const LoadsOfEveryNumber all(range.end);
  const Points f = Points::Random(3, range.end), v = Points::Random(3, range.end);
  for (const VertexLoads& loads : all.of) {
    Points plain = f;
    for (Eigen::Index i = range.first; i < range.end; ++i) plain.col(i) = Loaded(f.col(i), loads, i, v.col(i));
    OnEveryTarget([&] {
      Points here = f;
      AddLoads(range, loads, v, here.middleCols(range.first, range.end - range.first));
      EXPECT_EQ(here, plain);
    });
  }
}

TEST(Ranges, WhatIsHeldAndWhatAPoseCarriesAsVertexByVertexOnEveryInstructionSet) {
  Pose pose;
  pose.rotation = Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, -1).normalized());
  pose.translation = {0.01, -0.02, 0.03};
  pose.angular_velocity = {0.3, 0.1, -0.2};
  pose.velocity = {0.05, 0.02, 0.01};
  std::vector<HoldPacket> packets(3);  // the last one not full
  const Points x = Points::Random(3, 24), v = Points::Random(3, 24);
  Points plain = Points::Zero(3, 24), held = plain;
  for (int i = 0; i < 21; ++i) {
    HoldPacket& packet = packets[i / kPacketVertices];
    const auto lane = packet.count++;
    const Eigen::Vector3d rest = Eigen::Vector3d::Random();
    const double stiffness = 10 + i, damping = 0.1 * i;
    packet.x[lane] = rest.x(), packet.y[lane] = rest.y(), packet.z[lane] = rest.z();
    packet.stiffness[lane] = stiffness, packet.damping[lane] = damping;
    packet.offset[lane] = 3 * (23 - i);
    held.col(23 - i) = stiffness * (rest - x.col(23 - i)) - damping * v.col(23 - i);
    plain.col(23 - i) = 0.5 * (stiffness * (pose.At(rest) - rest) + damping * pose.VelocityAt(rest));
  }
  Points first;
  OnEveryTarget([&] {
    Points here = Points::Zero(3, 24);
    AddCarried(PoseMatrices(pose), 0.5, packets.data(), packets.data() + packets.size(), here.data());
    EXPECT_LT((here - plain).norm(), 1e-14 * plain.norm());
    if (first.size() == 0) first = here;
    EXPECT_EQ(here, first);
    here.setZero();
    AddHeld(packets.data(), packets.data() + packets.size(), x.data(), v.data(), here.data());
    EXPECT_EQ(here, held);
  });
}

}  // namespace
}  // namespace phrenic
