// A state's way into the store and back, bit for bit.
#include "server/store/saved_state.h"

#include <gmock/gmock.h>

#include "tests/scalar_motion.h"

namespace phrenic::store {
namespace {

TEST(SavedState, ComesBackBitForBit) {
  const auto model = CompileWithScalars(kTriangle);
  const State state = RunTo(*model, 0.3, 0.01);
  const auto restored = Restore(*model, Save(state));
  ASSERT_TRUE(restored.ok()) << restored.status();
  EXPECT_EQ(restored->scalars.q, state.scalars.q);
  EXPECT_EQ(restored->scalars.v, state.scalars.v);
  EXPECT_EQ(StateHash(*restored), StateHash(state));
}

TEST(SavedState, HasNoScalarsWhereTheModelHasNone) {
  const v1::SavedState saved = Save(CompileText(kTriangle)->InitialState());
  EXPECT_EQ(saved.scalars_size(), 0);
  EXPECT_EQ(saved.scalar_rates_size(), 0);
}

TEST(SavedState, OfBeforeTheModelHadScalarsStartsThemAnew) {
  const auto model = CompileWithScalars(kTriangle);
  v1::SavedState saved = Save(RunTo(*model, 0.3, 0.01));
  saved.clear_scalars();
  saved.clear_scalar_rates();
  const auto restored = Restore(*model, saved);
  ASSERT_TRUE(restored.ok()) << restored.status();
  EXPECT_EQ(restored->scalars.q, model->InitialState().scalars.q);
}

TEST(SavedState, OfOtherCoordinatesIsRefused) {
  const auto model = CompileWithScalars(kTriangle);
  v1::SavedState saved = Save(model->InitialState());
  saved.mutable_scalar_rates()->RemoveLast();
  const auto restored = Restore(*model, saved);
  EXPECT_EQ(restored.status().code(), absl::StatusCode::kDataLoss);
  EXPECT_THAT(std::string(restored.status().message()),
              testing::HasSubstr("scalars: 2 values and 1 rates are not of 2 coordinates"));
}

}  // namespace
}  // namespace phrenic::store
