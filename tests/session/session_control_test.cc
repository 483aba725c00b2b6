#include <gmock/gmock.h>

#include "server/session/session.h"
#include "tests/compile_text.h"
#include "tests/fake_clock.h"
#include "tests/small_scenes.h"

namespace phrenic::session {
namespace {

using testing::HasSubstr;

class SessionControlTest : public testing::Test {
 protected:
  std::unique_ptr<Session> Make(ControlBook control = {}) {
    const auto model = CompileText(kTriangle);
    Session::Fork start{model->parameters, model->InitialState(), model->report.stable_step().seconds()};
    return std::make_unique<Session>("test", model, std::move(start), clock_, Limits{},
                                     Session::Origin{.control = std::move(control)});
  }
  static v1::Parameters Elasticity(double value) {
    v1::Parameters change;
    change.set_elasticity(value);
    return change;
  }
  static std::string HashAt(Session& session, std::int64_t tick) {
    const std::int64_t ticks = tick - session.status().tick();
    const auto stepped = session.Step(ticks, std::nullopt, [] { return false; });
    EXPECT_TRUE(stepped.ok()) << stepped.status();
    return stepped.ok() ? stepped->state_hash : "";
  }
  std::string Enter(Session& session, const std::string& name) {
    std::string token;
    const auto entered = session.ChangeControl([&](ControlBook& book, absl::Time now) {
      auto got = book.Enter(name, "", absl::Seconds(30), now);
      if (got.ok()) token = *got;
      return got.status();
    });
    EXPECT_TRUE(entered.ok()) << entered.status();
    return token;
  }
  static absl::Status Hand(Session& session, const std::string& token, const std::string& name) {
    return session.ChangeControl([&](ControlBook& book, absl::Time now) { return book.Hand(token, name, now); })
        .status();
  }

  FakeClock clock_;
  ControlBook book_ = *ControlBook::Make(v1::CONTROL_POLICY_OWNER, "Anna");
  const std::string anna_ = book_.state().owner.token;
};

// Updates made between steps, or for later ticks in another order, stepped at once, in parts, or played: all runs are
// equal.
TEST_F(SessionControlTest, UpdatesBoundToTicksGiveTheSameRunTwice) {
  const auto by_hand = Make(), bound = Make(), played = Make();
  HashAt(*by_hand, 20);
  ASSERT_TRUE(by_hand->Update(Elasticity(3), std::nullopt).ok());
  HashAt(*by_hand, 35);
  ASSERT_TRUE(by_hand->Update(Elasticity(0.5), std::nullopt).ok());
  const std::string wanted = HashAt(*by_hand, 60);
  for (Session* session : {bound.get(), played.get()}) {
    ASSERT_TRUE(session->Update(Elasticity(0.5), std::nullopt, 35).ok());
    ASSERT_TRUE(session->Update(Elasticity(3), std::nullopt, 20).ok());
    EXPECT_EQ(session->status().waiting_updates(), 2);
  }
  HashAt(*bound, 27);
  EXPECT_EQ(bound->status().waiting_updates(), 1);
  EXPECT_EQ(bound->status().parameters().elasticity(), 3);
  EXPECT_EQ(HashAt(*bound, 60), wanted);
  ASSERT_TRUE(played->Play(std::nullopt, true, 0.6).ok());
  ASSERT_TRUE(Eventually([&] { return played->status().state() == v1::SESSION_STATE_PAUSED; }));
  EXPECT_EQ(HashText(played->MakeFork()->state), wanted);
  EXPECT_EQ(by_hand->status().largest_stable_step(), bound->status().largest_stable_step());
  EXPECT_NE(HashAt(*Make(), 60), wanted);
}

TEST_F(SessionControlTest, UpdatesForOneTickAreAppliedInTheirOrder) {
  const auto session = Make();
  for (const double value : {2.0, 5.0, 3.0}) ASSERT_TRUE(session->Update(Elasticity(value), std::nullopt, 4).ok());
  HashAt(*session, 4);
  EXPECT_EQ(session->status().parameters().elasticity(), 3);
}

TEST_F(SessionControlTest, APastTickIsRefusedAndResetDiscardsWaitingUpdates) {
  const auto session = Make();
  HashAt(*session, 10);
  const auto past = session->Update(Elasticity(2), std::nullopt, 9);
  EXPECT_TRUE(absl::IsFailedPrecondition(past.status()));
  EXPECT_THAT(std::string(past.status().message()), HasSubstr("apply_at_tick: 9 is past, the session is at tick 10"));
  EXPECT_EQ(session->Update(Elasticity(2), std::nullopt, 10)->session.parameters().elasticity(), 2);
  ASSERT_TRUE(session->Update(Elasticity(3), std::nullopt, 12).ok());
  ASSERT_TRUE(session->Reset().ok());
  EXPECT_EQ(session->status().waiting_updates(), 0);
  HashAt(*session, 20);
  EXPECT_EQ(session->status().parameters().elasticity(), 2);
}

TEST_F(SessionControlTest, TheNumberOfWaitingUpdatesIsBounded) {
  const auto session = Make();
  for (std::size_t i = 0; i < kMostWaiting; ++i) {
    ASSERT_TRUE(session->Update(Elasticity(2), std::nullopt, 5).ok());
  }
  EXPECT_TRUE(absl::IsResourceExhausted(session->Update(Elasticity(2), std::nullopt, 5).status()));
}

TEST_F(SessionControlTest, EveryChangeRequiresControl) {
  const auto session = Make(book_);
  for (const std::string& token : {std::string(), Enter(*session, "Ben")}) {
    EXPECT_TRUE(absl::IsPermissionDenied(session->Play(1, false, 0, token).status()));
    EXPECT_TRUE(absl::IsPermissionDenied(session->Pause(token).status()));
    EXPECT_TRUE(absl::IsPermissionDenied(session->Reset(token).status()));
    EXPECT_TRUE(absl::IsPermissionDenied(session
                                             ->Step(
                                                 1, std::nullopt, [] { return false; }, token)
                                             .status()));
    EXPECT_TRUE(absl::IsPermissionDenied(session->Update(Elasticity(2), std::nullopt, {}, token).status()));
    EXPECT_TRUE(absl::IsPermissionDenied(session->Pull({}, true, token).status()));
    EXPECT_TRUE(absl::IsPermissionDenied(session->CheckControl(token)));
    EXPECT_TRUE(absl::IsPermissionDenied(session->ShowCamera({}, token)));
  }
  EXPECT_EQ(session->status().revision(), 1) << "something changed all the same";
  EXPECT_TRUE(session->Update(Elasticity(2), 1, {}, anna_).ok());
}

// Returns the last control that the viewer got.
std::string ToldController(stream::Viewer& viewer, std::string told) {
  for (stream::Bytes bytes = viewer.Take(absl::Now()); bytes != nullptr; bytes = viewer.Take(absl::Now())) {
    v1::WatchFramesResponse response;
    EXPECT_TRUE(response.ParseFromString(*bytes));
    if (response.has_session()) told = response.session().control().controller();
  }
  return told;
}

TEST_F(SessionControlTest, ViewersOfAPausedSessionGetEachChangeOfControl) {
  const auto session = Make(book_);
  const auto viewer = session->publisher().Join({}, [] {});
  ASSERT_TRUE(viewer.ok());
  std::string told;
  const auto tells = [&](const std::string& name) {
    return Eventually([&] { return (told = ToldController(**viewer, told)) == name; });
  };
  EXPECT_TRUE(tells("Anna"));
  const std::string ben = Enter(*session, "Ben");
  ASSERT_TRUE(Hand(*session, anna_, "Ben").ok());
  EXPECT_TRUE(tells("Ben"));
  clock_.Advance(absl::Seconds(31));
  EXPECT_TRUE(tells("Anna"));
  EXPECT_EQ(session->status().control().participants_size(), 0);
}

TEST_F(SessionControlTest, ALateViewerGetsTheCameraOfTheOneWhoControls) {
  const auto session = Make(book_);
  v1::Camera camera;
  camera.mutable_eye()->set_x(2);
  camera.mutable_target();
  ASSERT_TRUE(session->ShowCamera(camera, anna_).ok());
  const auto eye_of = [&] {
    const auto viewer = session->publisher().Join({}, [] {});
    EXPECT_TRUE(viewer.ok());
    double eye = -1;
    bool frame = false;  // comes after the camera
    EXPECT_TRUE(Eventually([&] {
      const stream::Bytes bytes = (*viewer)->Take(absl::Now());
      v1::WatchFramesResponse response;
      if (bytes == nullptr || !response.ParseFromString(*bytes)) return frame;
      if (response.has_camera()) eye = response.camera().eye().x();
      return frame = frame || response.has_frame();
    }));
    session->publisher().Leave(*viewer);
    return eye;
  };
  EXPECT_EQ(eye_of(), 2);
  Enter(*session, "Ben");
  ASSERT_TRUE(Hand(*session, anna_, "Ben").ok());
  EXPECT_EQ(eye_of(), -1) << "the camera is that of somebody who does not control any more";
}

}  // namespace
}  // namespace phrenic::session
