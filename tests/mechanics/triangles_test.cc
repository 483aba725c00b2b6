// Triangles worked out several at a time, held against one at a time.
#include <gtest/gtest.h>

#include <random>

#include "server/mechanics/forces/corotated.h"
#include "server/mechanics/forces/triangle_kernel.h"
#include "tests/compile_text.h"
#include "tests/mechanics/every_target.h"

namespace phrenic {
namespace {

const char kSheet[] =
    "name: 'sheet' bodies { name: 'sheet' role: ROLE_DEFORMABLE mass: 1 grid { columns: 7 rows: 6 u { x: 0.1 } v { x: "
    "0.03 y: 0.1 } } } forces { membrane { bodies: 'sheet' youngs_modulus: 900 poissons_ratio: 0.4 thickness: 0.02 } "
    "} parameters { elasticity: 1.5 }";

// f_a = -V R (2 mu e + lambda tr(e) I) g_a, as the header has it.
Points ByOne(const Model& model, const Points& x) {
  const Lame lame = PlaneStress(900, 0.4);
  Points f = Points::Zero(3, x.cols());
  for (const auto& corners : model.bodies[0].mesh.triangles.colwise()) {
    const FiniteElement<2> element = MakeTriangle(model.rest, corners, 0.02);
    const Gradient<2> gradient = DeformationOf(element, x), r = NearestRotation(gradient);
    const Eigen::Matrix2d s = r.transpose() * gradient;
    const Eigen::Matrix2d strain = 0.5 * (s + s.transpose()) - Eigen::Matrix2d::Identity();
    const Eigen::Matrix2d stress = 2 * lame.mu * strain + lame.lambda * strain.trace() * Eigen::Matrix2d::Identity();
    AddStress<2>(element, 1.5 * r * stress, f);
  }
  return f;
}

class TriangleForce : public testing::Test {
 protected:
  TriangleForce() : model_(CompileText(kSheet)), state_(model_->InitialState()) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> value(-0.05, 0.05);
    state_.x += Points::NullaryExpr(3, state_.x.cols(), [&] { return value(random); });
  }
  Points Force() const {
    Points f = Points::Zero(3, state_.x.cols());
    model_->forces.front()->AddForce(MakeEvalContext(*model_, model_->parameters, state_), f);
    return f;
  }

  std::shared_ptr<const Model> model_;
  State state_;
};

TEST_F(TriangleForce, PullAsOneAtATimeWithTheSameBitsOnEveryInstructionSet) {
  const Points by_one = ByOne(*model_, state_.x), first = Force();
  OnEveryTarget([&] {
    EXPECT_LT((Force() - by_one).norm(), 1e-13 * by_one.norm());
    EXPECT_EQ(Force(), first);
  });
}

// Squashed to a point the rotation is any: it is the same as of one at a time. So it is to a line, and another one for
// every rounding: what it pulls by is bounded.
TEST_F(TriangleForce, PullBackFromNoArea) {
  const Eigen::Vector3i corners = model_->bodies[0].mesh.triangles.col(9);
  const double before = Force().norm();
  state_.x.col(corners[1]) = state_.x.col(corners[2]) = state_.x.col(corners[0]);
  EXPECT_LT(Force().norm(), 10 * before);
  state_.x = state_.x.col(0).replicate(1, state_.x.cols()).eval();
  EXPECT_LT((Force() - ByOne(*model_, state_.x)).norm(), 1e-12);
  EXPECT_GT(Force().norm(), before);
}

}  // namespace
}  // namespace phrenic
