// What is worked out range by range gives the bits of the whole, on every instruction set that this machine has.
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "server/mechanics/advance.h"
#include "server/mechanics/vertex_kernel.h"
#include "tests/compile_text.h"
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
  const Instant at = MakeInstant(*model, model->parameters, state);
  for (const auto& force : model->forces) {
    ASSERT_TRUE(force->by_range()) << force->name();
    Points whole = Points::Zero(3, state.x.cols()), parts = whole;
    force->AddForce(at, whole);
    ForEachBlock({0, state.x.cols()}, [&](const VertexRange& block) {
      const Points before = parts;
      force->AddForceIn(block, at, parts);
      Points others = parts - before;
      others.middleCols(block.first, block.end - block.first).setZero();
      EXPECT_EQ(others.norm(), 0) << force->name() << " reaches beyond its range";
    });
    EXPECT_EQ(parts, whole) << force->name();
    EXPECT_GT(whole.norm(), 0) << force->name();
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
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    Points v_here = v, x_here = x;
    KickAndDrift(range, w, 0.3, 0.7, f, x, v_here, x_here);
    EXPECT_EQ(v_here, v_plain);
    EXPECT_EQ(x_here, x_plain);
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace
}  // namespace phrenic
