// What is worked out range by range gives the bits of the whole, on every instruction set that this machine has.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "server/mechanics/advance.h"
#include "server/mechanics/forces/attachment_kernel.h"
#include "server/mechanics/vertex_kernel.h"
#include "tests/compile_text.h"
#include "tests/mechanics/every_target.h"
#include "tests/mechanics/mixed_sheet.h"

namespace phrenic {
namespace {

TEST(Ranges, GiveEachForceTheBitsOfTheWhole) {
  const auto model = CompileText(kMixedSheet);
  ASSERT_NE(model, nullptr);
  State state = model->InitialState();
  ASSERT_GT(state.x.cols(), 2 * kVertexBlock);
  state.phase = 0.3;
  state.x += 0.002 * Points::Random(3, state.x.cols());
  state.v = Points::Random(3, state.x.cols());
  const Instant at = Packed(*model, MakeInstant(*model, model->parameters, state));
  for (const Force* force : model->step_forces) {
    ASSERT_TRUE(force->by_range()) << force->name();
    Points whole = Points::Zero(3, state.x.cols()), parts = whole;
    force->AddForce(at, whole);
    ForEachBlock({0, state.x.cols()}, [&](const VertexRange& block) {
      const Eigen::Index vertices = block.end - block.first;
      Points guarded = Points::Zero(3, vertices + 2);  // a column before the range's own, and one after
      force->AddForceIn(block, at, guarded.middleCols(1, vertices));
      parts.middleCols(block.first, vertices) = guarded.middleCols(1, vertices);
      EXPECT_EQ(guarded.col(0).norm() + guarded.col(vertices + 1).norm(), 0)
          << force->name() << " reaches beyond its range";
    });
    EXPECT_EQ(parts, whole) << force->name();
    EXPECT_GT(whole.norm(), 0) << force->name();
  }
}

TEST(Ranges, SetTheForceThatTheyWouldAddToNothingOnEveryInstructionSet) {
  const auto model = CompileText(kMixedSheet);
  ASSERT_NE(model, nullptr);
  State state = model->InitialState();
  state.phase = 0.3;
  state.x += 0.002 * Points::Random(3, state.x.cols());
  state.v = Points::Random(3, state.x.cols());
  OnEveryTarget([&] {
    const Instant at = Packed(*model, MakeInstant(*model, model->parameters, state));
    for (const Force* force : model->step_forces) {
      ForEachBlock({0, state.x.cols()}, [&](const VertexRange& block) {
        Points added = Points::Zero(3, block.end - block.first);
        Points set = Points::Constant(3, block.end - block.first, std::nan(""));
        force->AddForceIn(block, at, added);
        force->SetForceIn(block, at, set);
        EXPECT_EQ(set, added) << force->name() << " from vertex " << block.first;
      });
    }
  });
}

TEST(Ranges, ReachAsCoordinateByCoordinateOnEveryInstructionSet) {
  const VertexRange range{8, 45};
  Points x = Points::Random(3, 45), v = Points::Random(3, 45);
  x.col(7).setConstant(9), v.col(7).setConstant(9);  // beside the range
  const auto own = [&](const Points& of) { return of.rightCols(range.end - range.first); };
  for (const double one : {-3.0, std::numeric_limits<double>::infinity(), std::nan("")}) {
    for (const Eigen::Index vertex : {8, 20, 44}) {
      Points there = x;
      there(1, vertex) = one;
      OnEveryTarget([&] {
        const StateReach reach = ReachOf(range, there, v);
        EXPECT_TRUE(reach.furthest == std::abs(one) || (std::isnan(one) && std::isnan(reach.furthest))) << vertex;
        EXPECT_NEAR(reach.squares, own(v).squaredNorm(), 1e-13);
      });
    }
  }
}

TEST(Ranges, KickAndDriftAsVertexByVertexOnEveryInstructionSet) {
  const Eigen::Index vertices = 45;
  const VertexRange range{8, vertices};
  const Points f = Points::Random(3, vertices), x = Points::Random(3, vertices), v = Points::Random(3, vertices);
  Eigen::VectorXd w = Eigen::VectorXd::Random(vertices).cwiseMax(0);  // about half of them fixed
  Points v_plain = v, x_plain = x;
  for (Eigen::Index i = range.first; i < range.end; ++i) {
    if (w[i] == 0) continue;
    v_plain.col(i) += 0.3 * w[i] * f.col(i);
    x_plain.col(i) += 0.7 * v_plain.col(i);
  }
  OnEveryTarget([&] {
    Points v_here = v, x_here = x;
    KickAndDrift(range, w, 0.3, 0.7, f.middleCols(range.first, range.end - range.first), x, v_here, x_here, v_here);
    EXPECT_EQ(v_here, v_plain);
    EXPECT_EQ(x_here, x_plain);
  });
}

TEST(Ranges, SharesOfAForceAsVertexByVertexOnEveryInstructionSet) {
  const Eigen::Index vertices = 45;
  const VertexRange range{8, vertices};
  const Eigen::VectorXd share = Eigen::VectorXd::Random(vertices);
  const Eigen::Vector3d force(0.3, -0.2, 0.7);
  const Points f = Points::Random(3, vertices);
  Points plain = f;
  for (Eigen::Index i = range.first; i < range.end; ++i) plain.col(i) += share[i] * force;
  OnEveryTarget([&] {
    Points here = f;
    AddShares(range, share, force, here.middleCols(range.first, range.end - range.first));
    EXPECT_EQ(here, plain);
  });
}

TEST(Ranges, WhatAPoseCarriesAsVertexByVertexOnEveryInstructionSet) {
  Pose pose;
  pose.rotation = Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, -1).normalized());
  pose.translation = {0.01, -0.02, 0.03};
  pose.angular_velocity = {0.3, 0.1, -0.2};
  pose.velocity = {0.05, 0.02, 0.01};
  std::vector<CarriedPacket> packets(3);  // the last one not full
  Points plain = Points::Zero(3, 24);
  for (int i = 0; i < 21; ++i) {
    CarriedPacket& packet = packets[i / kPacketVertices];
    const auto lane = packet.count++;
    const Eigen::Vector3d rest = Eigen::Vector3d::Random();
    const double stiffness = 10 + i, damping = 0.1 * i;
    packet.x[lane] = rest.x(), packet.y[lane] = rest.y(), packet.z[lane] = rest.z();
    packet.stiffness[lane] = stiffness, packet.damping[lane] = damping;
    packet.place[lane] = 3 * (23 - i);
    plain.col(23 - i) = 0.5 * (stiffness * (pose.At(rest) - rest) + damping * pose.VelocityAt(rest));
  }
  Points first;
  OnEveryTarget([&] {
    Points here = Points::Zero(3, 24);
    AddCarried(pose, 0.5, packets.data(), packets.data() + packets.size(), here.data());
    EXPECT_LT((here - plain).norm(), 1e-14 * plain.norm());
    if (first.size() == 0) first = here;
    EXPECT_EQ(here, first);
  });
}

}  // namespace
}  // namespace phrenic
