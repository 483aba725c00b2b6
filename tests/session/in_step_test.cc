#include <gmock/gmock.h>

#include "server/session/session.h"
#include "tests/compile_text.h"
#include "tests/fake_clock.h"
#include "tests/small_scenes.h"

namespace phrenic::session {
namespace {

// Two sessions of one scene, on a fake clock.
class InStepTest : public testing::Test {
 protected:
  std::unique_ptr<Session> Start(const char* id) {
    Session::Fork start{model_->parameters, model_->InitialState(), model_->report.stable_step().seconds()};
    return std::make_unique<Session>(id, model_, std::move(start), clock_, Limits{});
  }
  // Advances the clock frame by frame until `condition` holds. A session on a stalled machine skips what it cannot
  // catch up with, so that no number of frames is enough everywhere. Returns false after ten seconds of real time.
  template <class Condition>
  bool PassUntil(const Condition& condition) {
    return Eventually([&] {
      if (condition()) return true;
      clock_.Advance(absl::Seconds(1 / kFramesPerSecond + 1e-6));
      return false;
    });
  }
  // Reads the time of `behind_` last: a step between the two never makes them look further apart.
  double Apart() const {
    const double ahead = ahead_->status().time();
    return ahead - behind_->status().time();
  }

  static constexpr double kFrame = 1 / kFramesPerSecond;
  FakeClock clock_;
  const std::shared_ptr<const Model> model_ = CompileText(kTriangle);
  const std::unique_ptr<Session> behind_ = Start("behind"), ahead_ = Start("ahead");
};

TEST_F(InStepTest, TheFasterSessionWaitsForTheSlowerOne) {
  ASSERT_TRUE(ahead_->Play(1, false, 0, {}, behind_->reached()).ok());
  ASSERT_TRUE(behind_->Play(0.25, false, 0, {}, ahead_->reached()).ok());
  ASSERT_TRUE(PassUntil([&] { return behind_->status().time() > 0.2; }));
  EXPECT_LT(behind_->status().time(), 0.3);
  EXPECT_LE(Apart(), kFrame + 1e-6);
}

TEST_F(InStepTest, ASessionAsFastAsPossibleWaitsToo) {
  ASSERT_TRUE(behind_->Play(0.25, false, 0).ok());
  ASSERT_TRUE(ahead_->Play(1, true, 0, {}, behind_->reached()).ok());
  ASSERT_TRUE(PassUntil([&] { return ahead_->status().time() > 0.08; }));
  EXPECT_LE(Apart(), kFrame + 1e-6);
}

TEST_F(InStepTest, WithoutALeaderSessionsDriftApart) {
  ASSERT_TRUE(ahead_->Play(1, false, 0).ok());
  ASSERT_TRUE(behind_->Play(0.25, false, 0).ok());
  EXPECT_TRUE(PassUntil([&] { return Apart() > 0.1; }));
}

TEST_F(InStepTest, APausedLeaderDelaysNoFollower) {
  ASSERT_TRUE(behind_->Play(1, false, 0).ok());
  ASSERT_TRUE(ahead_->Play(1, false, 0, {}, behind_->reached()).ok());
  ASSERT_TRUE(behind_->Pause().ok());
  EXPECT_TRUE(PassUntil([&] { return Apart() > 0.2; }));
}

TEST_F(InStepTest, AFollowerFarAheadOrWithoutItsLeaderContinues) {
  ASSERT_TRUE(ahead_->Step(500, std::nullopt, [] { return false; }).ok());
  ASSERT_GT(Apart(), 2);
  ASSERT_TRUE(behind_->Play(0.01, false, 0).ok());
  ASSERT_TRUE(ahead_->Play(1, false, 0, {}, behind_->reached()).ok());
  const double before = ahead_->status().time();
  EXPECT_TRUE(PassUntil([&] { return ahead_->status().time() > before + 0.05; }));
  auto other = Start("other");
  ASSERT_TRUE(behind_->Play(1, false, 0, {}, other->reached()).ok());
  other.reset();
  EXPECT_TRUE(PassUntil([&] { return behind_->status().time() > 0.1; }));
}

}  // namespace
}  // namespace phrenic::session
