// A saved session continues as if it had never been interrupted.
#include <gmock/gmock.h>
#include <google/protobuf/text_format.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "server/session/saving.h"
#include "server/session/table.h"
#include "server/store/saved_state.h"
#include "tests/fake_clock.h"
#include "tests/small_scenes.h"

namespace phrenic::session {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

bool NeverCancelled() { return false; }

// A server's models, table and store, which the test ends and starts again.
class RestoreTest : public testing::Test {
 protected:
  RestoreTest() {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_ + "/scenes");
    WriteScene(kTriangle);
    Begin();
  }
  ~RestoreTest() override {
    End();
    std::filesystem::remove_all(folder_);
  }

  void WriteScene(const std::string& text) const { std::ofstream(folder_ + "/scenes/triangle.textproto") << text; }
  // Starts the server, without its sessions.
  void Open() {
    auto store = store::Store::Open(folder_ + "/store");
    ASSERT_TRUE(store.ok()) << store.status();
    store_ = *std::move(store);
    uploads_ = std::make_unique<Uploads>(Limits(), testing::TempDir());
    models_ = std::make_unique<Models>(SceneCatalogue({folder_ + "/scenes"}), "", 4, uploads_.get());
    table_ = std::make_unique<Table>(*models_, clock_, Limits(), store_.get());
  }
  void Begin() {
    Open();
    auto lost = table_->Restore([](const std::string&) {});
    ASSERT_TRUE(lost.ok()) << lost.status();
    lost_ = *std::move(lost);
  }
  void End() {
    table_.reset();
    store_.reset();
  }
  void Again() {
    End();
    Begin();
  }
  std::shared_ptr<Session> Create(const std::string& id) {
    v1::CreateSessionRequest request;
    request.set_session_id(id);
    request.mutable_source()->set_name("triangle");
    auto session = table_->Create(request);
    EXPECT_TRUE(session.ok()) << session.status();
    return *session;
  }
  std::shared_ptr<Session> Find(const std::string& id) {
    auto session = table_->Find(id);
    EXPECT_TRUE(session.ok()) << session.status();
    return *session;
  }
  static std::string HashAfter(Session& session, std::int64_t ticks) {
    const auto stepped = session.Step(ticks, std::nullopt, NeverCancelled);
    EXPECT_TRUE(stepped.ok()) << stepped.status();
    return stepped.ok() ? stepped->state_hash : "";
  }
  static void Set(Session& session, double force) {
    v1::Parameters parameters;
    parameters.set_breath_force(force);
    EXPECT_TRUE(session.Update(parameters, std::nullopt).ok());
  }
  static void Pull(Session& session, double force) {
    PullList pulls;
    v1::Pull& pull = *pulls.Add();
    pull.set_body("sheet");
    pull.set_vertex(2);
    pull.mutable_force()->set_x(force);
    EXPECT_TRUE(session.Pull(pulls, false).ok());
  }
  static void Reset(Session& session) { EXPECT_TRUE(session.Reset().ok()); }

  const std::string folder_ = testing::TempDir() + "phrenic_restore_" + std::to_string(getpid());
  FakeClock clock_;
  std::unique_ptr<store::Store> store_;
  std::unique_ptr<Uploads> uploads_;
  std::unique_ptr<Models> models_;
  std::unique_ptr<Table> table_;
  std::map<std::string, absl::Status> lost_;
};

// `whole` has the same history, without a store and without an interruption.
TEST_F(RestoreTest, ARestoredSessionEqualsTheUninterruptedOneBitForBit) {
  std::mt19937 random(11);
  const auto model = Create("saved")->shared_model();
  Session whole("whole", model, {model->parameters, model->InitialState(), 0.01}, clock_, Limits{});
  for (int round = 0; round < 12; ++round) {
    const auto what = random() % 3;
    const double amount = 0.1 * static_cast<double>(1 + random() % 20);
    const auto ticks = static_cast<std::int64_t>(1 + random() % 30);
    for (Session* session : {Find("saved").get(), &whole}) {
      if (what == 0) Set(*session, amount);
      if (what == 1) Pull(*session, amount);
      if (what == 2 && round > 6) Reset(*session);
      HashAfter(*session, ticks);
    }
    const v1::Session before = Find("saved")->status();
    End();
    if (round % 3 == 0) clock_.Advance(absl::Seconds(3));
    Begin();
    const v1::Session after = Find("saved")->status();
    EXPECT_EQ(after.tick(), before.tick());
    EXPECT_EQ(after.time(), before.time());
    EXPECT_EQ(after.revision(), before.revision());
    EXPECT_EQ(after.parameters().SerializeAsString(), before.parameters().SerializeAsString());
    EXPECT_EQ(after.pulls_size(), before.pulls_size());
    EXPECT_EQ(after.create_time().seconds(), before.create_time().seconds());
    EXPECT_EQ(HashAfter(*Find("saved"), 5), HashAfter(whole, 5)) << "round " << round;
  }
  EXPECT_THAT(lost_, IsEmpty());
}

// Copies the files while the store has them open, which is what a server leaves that is killed.
TEST_F(RestoreTest, WhatACallHasReturnedSurvivesAKill) {
  auto session = Create("a");
  const std::string left = folder_ + "/left";
  for (int i = 1; i <= 40; ++i) {
    if (i % 10 == 0) Set(*session, 0.1 * i);
    const auto stepped = session->Step(1, std::nullopt, NeverCancelled);
    ASSERT_TRUE(stepped.ok()) << stepped.status();
    ASSERT_EQ(stepped->session.tick(), i);
    std::filesystem::remove_all(left);
    std::filesystem::copy(folder_ + "/store", left);
    const auto store = store::Store::Open(left);
    ASSERT_TRUE(store.ok()) << store.status();
    const auto saved = (*store)->Load();
    ASSERT_TRUE(saved.ok() && saved->size() == 1);
    const auto replayed = Replay(session->shared_model(), saved->front());
    ASSERT_TRUE(replayed.ok()) << replayed.status();
    EXPECT_EQ(HashText(replayed->state), stepped->state_hash) << "step " << i;
    EXPECT_EQ(replayed->moment.session().revision(), stepped->session.revision());
  }
}

TEST_F(RestoreTest, ASessionWithAnUploadedFileIsSavedWithTheFile) {
  const auto given = uploads_->Adopt({}, "tent.obj", "v 0 0 0\nv 100 0 0\nv 0 100 0\nv 0 0 100\nf 1 2 3\nf 1 3 4\n");
  ASSERT_TRUE(given.ok()) << given.status();
  v1::CreateSessionRequest request;
  request.set_session_id("given");
  ASSERT_TRUE(google::protobuf::TextFormat::ParseFromString(
      absl::StrCat(R"(name: "tent" bodies { name: "tent" role: ROLE_DEFORMABLE mass: 1 fixed_vertices: [0]
                      file { path: ")",
                   given->file.path(), R"(" } }
                      forces { springs { bodies: "tent" stiffness: 20 } }
                      forces { gravity { bodies: "tent" acceleration { z: -1 } } })"),
      request.mutable_source()->mutable_scene()));
  const auto session = table_->Create(request);
  ASSERT_TRUE(session.ok()) << session.status();
  ASSERT_TRUE(uploads_->Delete({}, given->file.path()).ok());
  v1::ForkSessionRequest fork;
  fork.set_session_id("given");
  fork.set_fork_id("fork");
  ASSERT_TRUE(table_->Fork(fork).ok());
  const std::string hash = HashAfter(**session, 20);
  Again();
  ASSERT_THAT(lost_, IsEmpty());
  EXPECT_EQ(HashText(Find("given")->MakeFork()->state), hash);
  EXPECT_EQ(HashAfter(*Find("fork"), 20), hash);
  EXPECT_EQ(uploads_->List({}).size(), 1u);
}

TEST_F(RestoreTest, APlayingSessionContinuesToPlay) {
  ASSERT_TRUE(Create("a")->Play(0.5, false, 7).ok());
  Again();
  EXPECT_EQ(Find("a")->status().state(), v1::SESSION_STATE_PLAYING);
  EXPECT_EQ(Find("a")->status().speed(), 0.5);
  clock_.Advance(absl::Seconds(0.034));
  EXPECT_TRUE(Eventually([&] { return Find("a")->status().tick() > 0; }));
}

// Sessions that play as fast as they can would take the processor from those that are not restored yet.
TEST_F(RestoreTest, SessionsPlayOnFromTheirStatesOnceAllAreRestored) {
  // A burst ends, and its tick is told, when time has passed.
  const auto tick_of = [this](const std::string& id) {
    clock_.Advance(absl::Milliseconds(20));
    return Find(id)->status().tick();
  };
  std::map<std::string, std::int64_t> ticks;
  for (const char* id : {"a", "b", "c", "d"}) {
    ASSERT_TRUE(Create(id)->Play(std::nullopt, true, 0).ok());
    ASSERT_TRUE(Eventually([&] { return tick_of(id) > 50; }));
    ticks[id] = 0;
  }
  std::map<std::string, std::shared_ptr<Session>> before;
  for (auto& [id, tick] : ticks) before[id] = Find(id);
  table_.reset();
  for (auto& [id, tick] : ticks) tick = before[id]->status().tick();
  Session whole("whole", before["a"]->shared_model(),
                {before["a"]->model().parameters, before["a"]->model().InitialState(), 0.01}, clock_, Limits{});
  before.clear();
  store_.reset();
  Open();
  std::size_t restored = 0;
  const auto look = [&](const std::string&) {
    absl::SleepFor(absl::Milliseconds(10));  // many steps of a session that plays
    clock_.Advance(absl::Milliseconds(20));
    const auto present = table_->List(0, "").sessions;
    EXPECT_LE(present.size(), restored++);
    for (const auto& session : present) EXPECT_EQ(session->status().tick(), ticks[session->id()]) << session->id();
  };
  ASSERT_TRUE(table_->Restore(look).ok());
  EXPECT_EQ(restored, ticks.size());
  for (const auto& [id, tick] : ticks) {
    EXPECT_TRUE(Eventually([&, id = id, tick = tick] { return tick_of(id) > tick; })) << id;
  }
  // From first to last tick, so that the whole run is stepped once.
  std::map<std::int64_t, std::string> hashes;
  for (const auto& [id, tick] : ticks) {
    const auto stepped = Find(id)->Step(1, std::nullopt, NeverCancelled);
    ASSERT_TRUE(stepped.ok()) << stepped.status();
    hashes[stepped->session.tick()] = stepped->state_hash;
  }
  for (const auto& [tick, hash] : hashes) EXPECT_EQ(HashAfter(whole, tick - whole.status().tick()), hash) << tick;
}

// Without time between two saved states, as the clock stands still.
TEST_F(RestoreTest, ASessionThatEndsIsSavedWithItsStateSoThatNothingIsSteppedAgain) {
  const auto session = Create("a");
  const std::string hash = HashAfter(*session, 30);
  Set(*session, 1.5);
  table_.reset();
  store_.reset();
  const auto store = store::Store::Open(folder_ + "/store");
  ASSERT_TRUE(store.ok()) << store.status();
  const auto saved = (*store)->Load();
  ASSERT_TRUE(saved.ok() && saved->size() == 1);
  EXPECT_TRUE(saved->front().later.empty());
  const auto state = store::Restore(session->model(), saved->front().state);
  ASSERT_TRUE(state.ok()) << state.status();
  EXPECT_EQ(HashText(*state), hash);
}

TEST_F(RestoreTest, ASessionEndsWithTheTableEvenIfACallerHoldsIt) {
  Create("held");
  for (int round = 0; round < 50; ++round) {
    ASSERT_TRUE(Find("held")->Play(1, true, 0).ok());
    const auto playing = Find("held");
    table_.reset();
    const std::int64_t tick = playing->status().tick();
    Again();
    ASSERT_EQ(Find("held")->status().tick(), tick) << "round " << round;
  }
}

TEST_F(RestoreTest, ASessionIsStillAskedToKeepPlayingAndACopyStillTemporary) {
  ASSERT_TRUE(Create("a")->Play(PlayRequest{.keep_playing = true}, "").ok());
  v1::ForkSessionRequest fork;
  fork.set_session_id("a");
  fork.set_fork_id("copy");
  fork.set_temporary(true);
  ASSERT_TRUE(table_->Fork(fork).ok());
  Again();
  EXPECT_TRUE(Find("a")->status().keep_playing());
  EXPECT_FALSE(Find("a")->status().temporary());
  EXPECT_TRUE(Find("copy")->status().temporary());
}

TEST_F(RestoreTest, OwnerAndWaitingUpdatesAreRestored) {
  auto session = Create("a");
  std::string token;
  const auto entered = session->ChangeControl([&](ControlBook& book, absl::Time now) {
    auto given = book.Enter("Anna", "", absl::Minutes(2), now);
    if (!given.ok()) return given.status();
    token = *given;
    return book.Take(token, now).status();
  });
  ASSERT_TRUE(entered.ok()) << entered.status();
  v1::Parameters later;
  later.set_breath_force(2);
  ASSERT_TRUE(session->Update(later, std::nullopt, 9, token).ok());
  Again();
  EXPECT_TRUE(absl::IsPermissionDenied(Find("a")->CheckControl("")));
  EXPECT_TRUE(Find("a")->CheckControl(token).ok());
  EXPECT_EQ(Find("a")->status().waiting_updates(), 1);
  ASSERT_TRUE(Find("a")->Step(9, std::nullopt, NeverCancelled, token).ok());
  EXPECT_EQ(Find("a")->status().parameters().breath_force(), 2);
}

TEST_F(RestoreTest, ADeletedSessionStaysDeleted) {
  Create("a");
  Create("b");
  ASSERT_TRUE(table_->Delete("a", "").ok());
  Again();
  EXPECT_TRUE(absl::IsNotFound(table_->Find("a").status()));
  EXPECT_TRUE(table_->Find("b").ok());
}

TEST_F(RestoreTest, AnEditedSceneOfTheCatalogueDoesNotChangeASession) {
  Create("a");
  const std::string hash = HashAfter(*Find("a"), 4);
  WriteScene(Retimed("time_step: 0.001"));
  Again();
  EXPECT_EQ(Find("a")->status().parameters().time_step(), 0.01);
  EXPECT_EQ(HashText(Find("a")->MakeFork()->state), hash);
}

TEST_F(RestoreTest, ADivergedSessionIsRestoredAsDiverged) {
  v1::Parameters wild;
  wild.set_time_step(1);
  wild.set_elasticity(10);
  auto session = Create("a");
  ASSERT_TRUE(session->Update(wild, std::nullopt).ok());
  EXPECT_TRUE(absl::IsOutOfRange(session->Step(10000, std::nullopt, NeverCancelled).status()));
  const std::string told = session->status().divergence().remedy();
  Again();
  EXPECT_EQ(Find("a")->status().state(), v1::SESSION_STATE_DIVERGED);
  EXPECT_EQ(Find("a")->status().divergence().remedy(), told);
  EXPECT_TRUE(absl::IsFailedPrecondition(Find("a")->Step(1, std::nullopt, NeverCancelled).status()));
  EXPECT_TRUE(Find("a")->Reset().ok());
}

TEST_F(RestoreTest, ASessionThatCannotBeRestoredStaysUntilItIsDeleted) {
  {
    v1::SavedScene scene;
    *scene.mutable_source()->mutable_scene() = (*models_->Resolve([] {
      v1::SceneSource source;
      source.set_name("triangle");
      return source;
    }()));
    scene.set_scene_hash("another");
    const auto journal = store_->Begin("odd", scene);
    v1::SavedMoment moment;
    moment.mutable_control()->set_policy(v1::CONTROL_POLICY_OWNER);
    moment.mutable_control()->mutable_owner()->set_name("Anna");
    moment.mutable_control()->mutable_owner()->set_token("anna's");
    journal->Keep(moment, std::make_shared<State>());
    ASSERT_TRUE(journal->Flush().ok());
  }
  Again();
  ASSERT_TRUE(lost_.contains("odd"));
  EXPECT_THAT(std::string(lost_["odd"].message()), HasSubstr("differ from those that it was made with"));
  v1::CreateSessionRequest request;
  request.set_session_id("odd");
  request.mutable_source()->set_name("triangle");
  EXPECT_THAT(std::string(table_->Create(request).status().message()), HasSubstr("could not be restored"));
  Again();
  EXPECT_TRUE(lost_.contains("odd"));
  EXPECT_TRUE(absl::IsPermissionDenied(table_->Delete("odd", ""))) << "it is Anna's";
  ASSERT_TRUE(table_->Delete("odd", "anna's").ok());
  EXPECT_TRUE(table_->Create(request).ok());
}

TEST_F(RestoreTest, AFullDiskIsReportedAndStopsNothing) {
  auto session = Create("a");
  ASSERT_TRUE(store_->LimitSize(4096).ok());
  for (int i = 1; i < 50 && session->status().not_saved().empty(); ++i) Set(*session, 0.1 * i);
  EXPECT_THAT(session->status().not_saved(), HasSubstr("is full"));
  Set(*session, 2);
  EXPECT_TRUE(session->Step(10, std::nullopt, NeverCancelled).ok());
  v1::CreateSessionRequest request;
  request.mutable_source()->set_name("triangle");
  EXPECT_TRUE(absl::IsResourceExhausted(table_->Create(request).status())) << "it could not be kept";
  ASSERT_TRUE(store_->LimitSize(1 << 28).ok());
  EXPECT_TRUE(Eventually([&] { return session->status().not_saved().empty(); }));
  Again();
  EXPECT_EQ(Find("a")->status().parameters().breath_force(), 2);
  EXPECT_EQ(Find("a")->status().tick(), 10);
}

TEST_F(RestoreTest, AccountAndJoinLinksAreRestored) {
  v1::CreateSessionRequest request;
  request.set_session_id("mine");
  request.mutable_source()->set_name("triangle");
  auto book = ControlBook::Make(v1::CONTROL_POLICY_EVERYBODY, "", "anna");
  ASSERT_TRUE(book.ok());
  auto session = table_->Create(request, *std::move(book));
  ASSERT_TRUE(session.ok());
  const absl::Time end = clock_.Now() + absl::Hours(1);
  const auto changed = (*session)->ChangeControl([end](ControlBook& control, absl::Time now) {
    return control.AddLink({"l1", "hash", v1::ACCESS_ROLE_CONTROLLER, end, "anna"}, now);
  });
  ASSERT_TRUE(changed.ok()) << changed.status();
  session->reset();
  Again();
  const auto access = Find("mine")->access();
  EXPECT_EQ(access->account, "anna");
  ASSERT_EQ(access->links.size(), 1u);
  EXPECT_EQ(access->links[0].id, "l1");
  EXPECT_EQ(access->links[0].secret_sha256, "hash");
  EXPECT_EQ(access->links[0].role, v1::ACCESS_ROLE_CONTROLLER);
  EXPECT_EQ(access->links[0].expires, end);
}

}  // namespace
}  // namespace phrenic::session
