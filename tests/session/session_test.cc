#include "server/session/session.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>

#include "tests/compile_text.h"
#include "tests/fake_clock.h"
#include "tests/small_scenes.h"

namespace phrenic::session {
namespace {

bool Never() { return false; }

class SessionTest : public testing::Test {
 protected:
  std::unique_ptr<Session> Make(const std::string& text = kTriangle) {
    const auto model = CompileText(text);
    Session::Fork start{model->parameters, model->InitialState(), model->report.stable_step().seconds()};
    return std::make_unique<Session>("test", model, std::move(start), clock_, Limits{.viewers = 8});
  }

  // Advances the clock by `seconds`, frame by frame, and waits for the session at each.
  void Pass(Session& session, double seconds, double speed = 1) {
    const double start = session.status().time();
    for (double passed = kFrame; passed < seconds + kFrame / 2; passed += kFrame) {
      clock_.Advance(absl::Seconds(kFrame));
      const double reached = start + speed * passed - session.status().parameters().time_step() - 1e-6;
      if (!Eventually([&] { return session.status().time() >= reached; })) return;
    }
  }

  static constexpr double kFrame = 0.016667;  // just over a sixtieth of a second: rounding never makes it less
  FakeClock clock_;
};

std::string HashAfter(Session& session, std::int64_t ticks) {
  const auto stepped = session.Step(ticks, std::nullopt, Never);
  EXPECT_TRUE(stepped.ok()) << stepped.status();
  return stepped.ok() ? stepped->state_hash : "";
}

TEST_F(SessionTest, StartsPausedAtZeroWithEveryParameterSet) {
  const auto session = Make();
  const v1::Session status = session->status();
  EXPECT_EQ(status.state(), v1::SESSION_STATE_PAUSED);
  EXPECT_EQ(status.time(), 0);
  EXPECT_EQ(status.tick(), 0);
  EXPECT_EQ(status.revision(), 1);
  EXPECT_EQ(status.scene(), "triangle");
  EXPECT_EQ(status.speed(), 1);
  EXPECT_GT(status.largest_stable_step(), 0);
  const auto* descriptor = v1::Parameters::descriptor();
  for (int i = 0; i < descriptor->field_count(); ++i) {
    EXPECT_TRUE(status.parameters().GetReflection()->HasField(status.parameters(), descriptor->field(i)))
        << descriptor->field(i)->name();
  }
}

TEST_F(SessionTest, StepsEqualTheMechanicsBitForBit) {
  const auto session = Make();
  const std::string hash = HashAfter(*session, 50);
  const State state = RunTo(session->model(), 0.5, 0.01);
  EXPECT_EQ(hash, HashText(state));
  EXPECT_EQ(session->status().tick(), 50);
  EXPECT_EQ(session->status().time(), state.time);
}

TEST_F(SessionTest, StateIsIndependentOfViewersAndOfHowStepsAreGrouped) {
  const auto whole = Make(), parts = Make();
  const auto viewer = parts->publisher().Join({}, [] {});
  ASSERT_TRUE(viewer.ok());
  HashAfter(*parts, 13);
  EXPECT_EQ(HashAfter(*whole, 50), HashAfter(*parts, 37));
}

TEST_F(SessionTest, PlayingGivesTheStatesOfStepping) {
  const auto played = Make(), stepped = Make();
  ASSERT_TRUE(played->Play(std::nullopt, false, 0.5).ok());
  Pass(*played, 0.5);
  ASSERT_TRUE(Eventually([&] { return played->status().state() == v1::SESSION_STATE_PAUSED; }));
  const auto fork = played->MakeFork();
  ASSERT_TRUE(fork.ok());
  EXPECT_EQ(HashText(fork->state), HashAfter(*stepped, fork->state.tick));
}

TEST_F(SessionTest, ReadingTheStateCopiesNone) {
  const auto session = Make();
  v1::Parameters fine;
  fine.set_time_step(0.001);
  ASSERT_TRUE(session->Update(fine, std::nullopt).ok());
  const std::string hash = HashAfter(*session, 7);
  const auto once = session->ReadState(), again = session->ReadState();
  ASSERT_TRUE(once.ok() && again.ok());
  EXPECT_EQ(HashText(once->state()), hash);
  EXPECT_EQ(once->frame, again->frame);
  ASSERT_TRUE(session->Play(std::nullopt, false, 0).ok());
  clock_.Advance(absl::Seconds(kFrame / 2));  // a command ends the wait for the next frame, and steps are taken
  ASSERT_TRUE(Eventually([&] { return session->MakeFork()->state.tick > 7; }));
  const auto playing = session->ReadState();
  ASSERT_TRUE(playing.ok());
  EXPECT_EQ(playing->frame, once->frame) << "a reader had the stepping thread copy the state";
}

TEST_F(SessionTest, AStateThatRestsIsReadWithThePresentParameters) {
  const auto session = Make();
  HashAfter(*session, 2);
  v1::Parameters change;
  change.set_breath_force(2.5);
  ASSERT_TRUE(session->Update(change, std::nullopt).ok());
  const auto read = session->ReadState();
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(read->state().tick, 2);
  EXPECT_EQ(read->parameters.breath_force(), 2.5);
}

TEST_F(SessionTest, AfterAStepThatWasCancelledTheLastStateIsRead) {
  const auto session = Make();
  int asked = 0;
  EXPECT_TRUE(absl::IsCancelled(session->Step(1'000'000'000, std::nullopt, [&] { return ++asked > 2; }).status()));
  const auto read = session->ReadState();
  const auto fork = session->MakeFork();
  ASSERT_TRUE(read.ok() && fork.ok());
  EXPECT_EQ(read->state().tick, fork->state.tick);
  EXPECT_EQ(HashText(read->state()), HashText(fork->state));
}

TEST_F(SessionTest, AStaleTickIsRefused) {
  const auto session = Make();
  HashAfter(*session, 3);
  const auto stale = session->Step(1, 2, Never);
  EXPECT_TRUE(absl::IsAborted(stale.status())) << stale.status();
  EXPECT_TRUE(session->Step(1, 3, Never).ok());
}

TEST_F(SessionTest, AStaleRevisionIsRefusedAndChangesNothing) {
  const auto session = Make();
  v1::Parameters change;
  change.set_breath_force(2);
  const auto first = session->Update(change, 1);
  ASSERT_TRUE(first.ok()) << first.status();
  EXPECT_EQ(first->session.revision(), 2);
  change.set_breath_force(3);
  EXPECT_TRUE(absl::IsAborted(session->Update(change, 1).status()));
  EXPECT_EQ(session->status().parameters().breath_force(), 2);
}

TEST_F(SessionTest, SimulatedTimeFollowsTheClockAtTheRequestedSpeed) {
  for (const double speed : {1.0, 0.5, 4.0}) {
    const auto session = Make();
    ASSERT_TRUE(session->Play(speed, false, 0).ok());
    Pass(*session, 1, speed);
    const double time = session->status().time();
    EXPECT_LE(time, speed * (1 + 1e-4));
    EXPECT_GE(time, speed - 0.011);
  }
}

TEST_F(SessionTest, ASlowMachineCatchesUpATenthOfASecondAtMost) {
  const auto session = Make();
  ASSERT_TRUE(session->Play(1, false, 0).ok());
  clock_.Advance(absl::Seconds(100));
  ASSERT_TRUE(Eventually([&] { return session->status().time() > 0.08; }));
  Pass(*session, 0.1);
  EXPECT_LT(session->status().time(), 0.25) << "the session runs after lost time";
}

TEST_F(SessionTest, AViewerSeesSixtyFramesASimulatedSecond) {
  const auto session = Make(Retimed("time_step: 0.001"));
  const auto viewer = session->publisher().Join({}, [] {});
  ASSERT_TRUE(viewer.ok());
  ASSERT_TRUE(session->Play(1, false, 0).ok());
  std::int64_t first = -1, last = -1;
  const auto take = [&] {
    for (stream::Bytes bytes = (*viewer)->Take(absl::Now()); bytes != nullptr; bytes = (*viewer)->Take(absl::Now())) {
      v1::WatchFramesResponse response;
      response.ParseFromString(*bytes);
      if (!response.has_frame()) continue;
      if (first < 0) first = response.frame().sequence();
      last = response.frame().sequence();
    }
    return last;
  };
  ASSERT_TRUE(Eventually([&] { return take() >= 1; }));
  Pass(*session, 1);
  EXPECT_TRUE(Eventually([&] { return take() - first >= 59; })) << last - first;
  EXPECT_LE(last - first, 61);
}

TEST_F(SessionTest, AsFastAsPossiblePausesAtTheRequestedTime) {
  const auto session = Make();
  const auto played = session->Play(std::nullopt, true, 5);
  ASSERT_TRUE(played.ok());
  EXPECT_EQ(played->speed(), 0);
  ASSERT_TRUE(Eventually([&] { return session->status().state() == v1::SESSION_STATE_PAUSED; }));
  EXPECT_EQ(session->status().tick(), 500);
  EXPECT_NEAR(session->status().time(), 5, 1e-9);
  const auto behind = session->Play(std::nullopt, true, 4);
  EXPECT_TRUE(absl::IsInvalidArgument(behind.status()));
  EXPECT_THAT(std::string(behind.status().message()), testing::HasSubstr("until_time"));
}

TEST_F(SessionTest, RevisionGrowsByOneWithEveryChange) {
  const auto session = Make();
  v1::Parameters change;
  change.set_rib_motion(0.5);
  EXPECT_EQ(session->Play(1, false, 0)->revision(), 2);
  EXPECT_EQ(session->Update(change, std::nullopt)->session.revision(), 3);
  EXPECT_EQ(session->Pause()->revision(), 4);
  EXPECT_EQ(session->Pause()->revision(), 4) << "a pause of a paused session changes nothing";
  EXPECT_EQ(session->Reset()->revision(), 5);
}

TEST_F(SessionTest, ParametersTakeEffectWhileItPlaysAndChangeTheMotion) {
  const auto plain = Make(), stiff = Make();
  v1::Parameters change;
  change.set_elasticity(4);
  ASSERT_TRUE(stiff->Update(change, std::nullopt).ok());
  EXPECT_NE(HashAfter(*plain, 50), HashAfter(*stiff, 50));
}

TEST_F(SessionTest, ATimeStepAboveTheStableOneGivesAWarning) {
  const auto session = Make();
  v1::Parameters change;
  change.set_elasticity(25);
  const auto stiff = session->Update(change, std::nullopt);
  change.set_elasticity(100);
  const auto stiffer = session->Update(change, std::nullopt);
  ASSERT_TRUE(stiff.ok() && stiffer.ok());
  EXPECT_TRUE(stiffer->warnings.empty());
  const double before = stiff->session.largest_stable_step();
  EXPECT_NEAR(stiffer->session.largest_stable_step(), before / 2, 0.02 * before);
  v1::Parameters step;
  step.set_time_step(0.1);
  const auto warned = session->Update(step, std::nullopt);
  ASSERT_TRUE(warned.ok());
  ASSERT_EQ(warned->warnings.size(), 1u);
  EXPECT_THAT(warned->warnings[0], testing::StartsWith("time_step: 0.1 s is above"));
}

class DivergedTest : public SessionTest {
 protected:
  std::unique_ptr<Session> session_ = Make(Retimed("time_step: 0.1 elasticity: 100"));
};

TEST_F(DivergedTest, StopsAndReportsTimeVertexForceAndRemedy) {
  const auto stepped = session_->Step(100000, std::nullopt, Never);
  EXPECT_EQ(stepped.status().code(), absl::StatusCode::kOutOfRange) << stepped.status();
  const v1::Session status = session_->status();
  EXPECT_EQ(status.state(), v1::SESSION_STATE_DIVERGED);
  EXPECT_EQ(status.divergence().body(), "sheet");
  EXPECT_FALSE(status.divergence().force().empty());
  EXPECT_THAT(status.divergence().remedy(), testing::HasSubstr("time_step"));
  EXPECT_GT(status.divergence().tick(), 0);
  EXPECT_THAT(std::string(stepped.status().message()), testing::HasSubstr(status.divergence().remedy()));
}

TEST_F(DivergedTest, EveryFrameIsFinite) {
  const auto viewer = session_->publisher().Join({}, [] {});
  ASSERT_TRUE(viewer.ok());
  ASSERT_TRUE(session_->Play(1, true, 0).ok());
  bool diverged = false;
  const auto all_finite = [&] {
    for (stream::Bytes bytes = (*viewer)->Take(absl::Now()); bytes != nullptr; bytes = (*viewer)->Take(absl::Now())) {
      v1::WatchFramesResponse response;
      EXPECT_TRUE(response.ParseFromString(*bytes));
      diverged = diverged || response.session().state() == v1::SESSION_STATE_DIVERGED;
      const std::string& positions = response.frame().positions();
      for (std::size_t i = 0; i + sizeof(float) <= positions.size(); i += sizeof(float)) {
        float value;
        std::memcpy(&value, positions.data() + i, sizeof value);
        EXPECT_TRUE(std::isfinite(value));
      }
    }
    return diverged;
  };
  EXPECT_TRUE(Eventually(all_finite)) << "the viewer never hears of the divergence";
}

TEST_F(DivergedTest, RefusesToContinueUntilItIsReset) {
  EXPECT_FALSE(session_->Step(100000, std::nullopt, Never).ok());
  EXPECT_TRUE(absl::IsFailedPrecondition(session_->Play(1, false, 0).status()));
  EXPECT_TRUE(absl::IsFailedPrecondition(session_->Step(1, std::nullopt, Never).status()));
  EXPECT_TRUE(absl::IsFailedPrecondition(session_->MakeFork().status()));
  const auto reset = session_->Reset();
  ASSERT_TRUE(reset.ok());
  EXPECT_EQ(reset->state(), v1::SESSION_STATE_PAUSED);
  EXPECT_FALSE(reset->has_divergence());
  v1::Parameters mild;
  mild.set_time_step(0.001);
  ASSERT_TRUE(session_->Update(mild, std::nullopt).ok());
  EXPECT_TRUE(session_->Step(100, std::nullopt, Never).ok());
}

TEST_F(SessionTest, ResetReturnsToTheStartAndKeepsParameters) {
  const auto session = Make();
  v1::Parameters change;
  change.set_elasticity(2);
  ASSERT_TRUE(session->Update(change, std::nullopt).ok());
  const std::string first = HashAfter(*session, 20);
  ASSERT_TRUE(session->Reset().ok());
  EXPECT_EQ(session->status().time(), 0);
  EXPECT_EQ(session->status().parameters().elasticity(), 2);
  EXPECT_EQ(HashAfter(*session, 20), first);
}

PullList PullOn(const std::string& body, int vertex, double z) {
  PullList list;
  v1::Pull& pull = *list.Add();
  pull.set_body(body);
  pull.set_vertex(vertex);
  pull.mutable_force()->set_z(z);
  return list;
}

TEST_F(SessionTest, APullChangesTheMotionUntilItIsReleased) {
  const auto session = Make(), other = Make();
  const auto pulled = session->Pull(PullOn("sheet", 2, 1), false);
  ASSERT_TRUE(pulled.ok()) << pulled.status();
  ASSERT_EQ(pulled->pulls_size(), 1);
  EXPECT_EQ(pulled->pulls(0).vertex(), 2);
  EXPECT_EQ(pulled->revision(), 2);
  EXPECT_NE(HashAfter(*session, 10), HashAfter(*other, 10));
  const auto let_go = session->Pull(PullOn("sheet", 2, 0), false);
  ASSERT_TRUE(let_go.ok());
  EXPECT_EQ(let_go->pulls_size(), 0);
}

// A session that is reset, forked or created with the same pulls moves the same, bit for bit.
TEST_F(SessionTest, PullsAreReproduced) {
  const auto session = Make(), again = Make();
  ASSERT_TRUE(session->Pull(PullOn("sheet", 2, 1), false).ok());
  ASSERT_TRUE(again->Pull(session->status().pulls(), true).ok());
  const std::string first = HashAfter(*session, 20);
  EXPECT_EQ(HashAfter(*again, 20), first);
  ASSERT_TRUE(session->Reset().ok());
  EXPECT_EQ(session->status().pulls_size(), 1);
  HashAfter(*session, 15);
  auto fork = session->MakeFork();
  ASSERT_TRUE(fork.ok());
  phrenic::session::Run run(session->shared_model(), fork->parameters, std::move(fork->state));
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(run.Step().ok());
  EXPECT_EQ(HashText(run.state()), first);
}

TEST_F(SessionTest, APullOnAMissingVertexIsRefusedAndChangesNothing) {
  const auto session = Make();
  EXPECT_EQ(session->Pull(PullOn("post", 0, 1), false).status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(session->status().revision(), 1);
}

TEST_F(SessionTest, ReportsTheConstraintResidualIfThereAreConstraints) {
  EXPECT_FALSE(Make()->status().has_constraint_residual());
  const auto session = Make(Triangle("constraints { rigid_links { body: 'sheet' list { links { a: 1 b: 2 } } } }"));
  EXPECT_TRUE(session->status().has_constraint_residual());
  HashAfter(*session, 50);
  EXPECT_LT(session->status().constraint_residual(), 1e-9);
  v1::Parameters off;
  off.set_apply_links(false);
  ASSERT_TRUE(session->Update(off, std::nullopt).ok());
  ASSERT_TRUE(session->Pull(PullOn("sheet", 2, 5), false).ok());
  HashAfter(*session, 50);
  EXPECT_GT(session->status().constraint_residual(), 1e-3);
  EXPECT_EQ(session->status().residual_constraint(), "rigid-links:sheet");
}

TEST_F(SessionTest, AForkIsACopyAndLeavesTheSessionUndisturbed) {
  const auto session = Make(), other = Make();
  HashAfter(*session, 10);
  auto fork = session->MakeFork();
  ASSERT_TRUE(fork.ok());
  phrenic::session::Run run(session->shared_model(), fork->parameters, std::move(fork->state));
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(run.Step().ok());
  const std::string expected = HashAfter(*other, 15);
  EXPECT_EQ(HashText(run.state()), expected);
  EXPECT_EQ(HashAfter(*session, 5), expected);
}

TEST_F(SessionTest, ACancelledCallEndsItsSteps) {
  const auto session = Make();
  const auto stepped = session->Step(1'000'000'000'000, std::nullopt, [] { return true; });
  EXPECT_TRUE(absl::IsCancelled(stepped.status()));
  EXPECT_TRUE(session->Step(1, std::nullopt, Never).ok());
}

TEST_F(SessionTest, StopWakesAWaitingSessionAtOnce) {
  for (const bool playing : {false, true}) {
    auto session = Make();
    if (playing) {
      ASSERT_TRUE(session->Play(0.01, false, 0).ok());
    }
    const absl::Time start = absl::Now();
    session->Stop(absl::NotFoundError("deleted"));
    EXPECT_TRUE(absl::IsNotFound(session->Pause().status()));
    session.reset();
    EXPECT_LT(absl::Now() - start, absl::Seconds(2));
  }
}

}  // namespace
}  // namespace phrenic::session
