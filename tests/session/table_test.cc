#include "server/session/table.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "server/session/meshes.h"
#include "tests/compile_text.h"
#include "tests/fake_clock.h"
#include "tests/small_scenes.h"

namespace phrenic::session {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

std::string Message(const absl::Status& status) { return std::string(status.message()); }

// Each test has its own folder with scenes and surface files.
class FolderTest : public testing::Test {
 protected:
  FolderTest() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) / (std::string("phrenic-") + test->test_suite_name() + test->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "scenes");
    Write("scenes/triangle.textproto", kTriangle);
  }
  ~FolderTest() override { fs::remove_all(folder_); }

  void Write(const std::string& path, const std::string& text) { std::ofstream(folder_ / path) << text; }
  SceneCatalogue Catalogue() const { return SceneCatalogue({(folder_ / "scenes").string()}); }

  fs::path folder_;
};

using CatalogueTest = FolderTest;
using MeshesTest = FolderTest;
using ModelsTest = FolderTest;

TEST_F(CatalogueTest, TheFolderIsTheCatalogue) {
  Write("scenes/again.textproto", kTriangle);
  Write("scenes/notes.txt", "not a scene");
  EXPECT_EQ(Catalogue().Names(), (std::vector<std::string>{"again", "triangle"}));
  const auto scenes = Catalogue().List();
  ASSERT_EQ(scenes.size(), 2u);
  EXPECT_EQ(scenes[1].title(), "Triangle");
}

TEST_F(CatalogueTest, AnUnknownSceneIsNotFoundAndTheErrorListsTheOthers) {
  for (const char* name : {"thorux", "../scenes/triangle", "/etc/passwd", ""}) {
    const auto missing = Catalogue().Find(name);
    EXPECT_TRUE(absl::IsNotFound(missing.status())) << name;
    EXPECT_THAT(Message(missing.status()), HasSubstr("there are triangle"));
  }
}

TEST_F(CatalogueTest, AMalformedSceneIsListedWithItsErrorAndRefusedWithItsLine) {
  Write("scenes/broken.textproto", "name: \"broken\"\nbodise { }\n");
  const auto broken = Catalogue().Find("broken");
  EXPECT_TRUE(absl::IsInvalidArgument(broken.status()));
  EXPECT_THAT(Message(broken.status()), HasSubstr("broken.textproto:2"));
  EXPECT_THAT(Catalogue().List()[0].description(), HasSubstr("bodise"));
}

TEST_F(MeshesTest, PathsStayBelowTheDataFolder) {
  Write("sheet.obj", "v 0 0 0\n");
  const std::string data = (folder_ / "scenes").string();
  Write("scenes/inside.obj", "v 0 0 0\n");
  EXPECT_TRUE(ResolveBelow(data, "inside.obj").ok());
  EXPECT_TRUE(absl::IsInvalidArgument(ResolveBelow(data, "../sheet.obj").status()));
  EXPECT_TRUE(absl::IsInvalidArgument(ResolveBelow(data, "x/../../sheet.obj").status()));
  EXPECT_TRUE(absl::IsInvalidArgument(ResolveBelow(data, (folder_ / "sheet.obj").string()).status()));
  fs::create_symlink(folder_ / "sheet.obj", folder_ / "scenes" / "link.obj");
  EXPECT_TRUE(absl::IsInvalidArgument(ResolveBelow(data, "link.obj").status()));
  EXPECT_TRUE(absl::IsNotFound(ResolveBelow(data, "missing.obj").status()));
  EXPECT_THAT(Message(ResolveBelow("", "inside.obj").status()), HasSubstr("--data"));
}

v1::SceneSource Named(const std::string& name) {
  v1::SceneSource source;
  source.set_name(name);
  return source;
}

TEST_F(ModelsTest, TheSameSceneIsCompiledOnce) {
  Models models(Catalogue(), "", 2);
  const auto first = models.Get(Named("triangle")), second = models.Get(Named("triangle"));
  ASSERT_TRUE(first.ok()) << first.status();
  EXPECT_EQ(*first, *second);
  Write("scenes/triangle.textproto", Retimed("time_step: 0.02"));
  const auto edited = models.Get(Named("triangle"));
  ASSERT_TRUE(edited.ok());
  EXPECT_EQ((*edited)->parameters.time_step(), 0.02) << "an edited scene is not seen";
}

TEST_F(ModelsTest, ASceneThatIsTooLargeIsRefusedBeforeItIsGenerated) {
  Models models(Catalogue(), "", 2);
  v1::SceneSource source;
  source.mutable_scene()->set_name("large");
  for (int i = 0; i < 3; ++i) {
    v1::Body& body = *source.mutable_scene()->add_bodies();
    body.set_name(std::string(1, static_cast<char>('a' + i)));
    body.set_role(v1::ROLE_DEFORMABLE);
    body.mutable_grid()->set_columns(2000);
    body.mutable_grid()->set_rows(2000);
    body.mutable_grid()->mutable_u()->set_x(0.1);
    body.mutable_grid()->mutable_v()->set_y(0.1);
  }
  const auto model = models.Get(source);
  EXPECT_TRUE(absl::IsResourceExhausted(model.status())) << model.status();
  EXPECT_THAT(Message(model.status()), HasSubstr("bodies[1].grid"));
}

class TableTest : public FolderTest {
 protected:
  absl::StatusOr<std::shared_ptr<Session>> Create(const std::string& id, const std::string& scene = "triangle") {
    v1::CreateSessionRequest request;
    request.set_session_id(id);
    *request.mutable_source() = Named(scene);
    return table_.Create(request);
  }

  FakeClock clock_;
  Models models_{Catalogue(), "", 2};
  Table table_{models_, clock_, {.sessions = 4}};
};

TEST_F(TableTest, IdsAreChosenByTheClientOrFromTheScene) {
  EXPECT_EQ((*Create("mine"))->id(), "mine");
  EXPECT_EQ((*Create(""))->id(), "triangle");
  EXPECT_EQ((*Create(""))->id(), "triangle-2");
  EXPECT_TRUE(absl::IsAlreadyExists(Create("mine").status()));
  for (const std::string bad : {"Mine", "a b", "a/b", "\xff"}) {
    EXPECT_TRUE(absl::IsInvalidArgument(Create(bad).status())) << bad;
  }
  EXPECT_TRUE(absl::IsInvalidArgument(Create(std::string(65, 'a')).status()));
}

TEST_F(TableTest, MoreSessionsThanAllowedAreRefused) {
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(Create("").ok());
  EXPECT_TRUE(absl::IsResourceExhausted(Create("").status()));
  ASSERT_TRUE(table_.Delete("triangle-3").ok());
  EXPECT_EQ((*Create(""))->id(), "triangle-3");
}

// The triangle is as large as a scene may be: an account has two of them, and all accounts together four.
TEST_F(TableTest, SessionsOfLargeScenesAreFewer) {
  Table table(models_, clock_, {.sessions = 16, .vertices = 3});
  const auto control = [](const std::string& account) {
    return *ControlBook::Make(v1::CONTROL_POLICY_UNSPECIFIED, "", account);
  };
  const auto create = [&](const std::string& account) {
    v1::CreateSessionRequest request;
    *request.mutable_source() = Named("triangle");
    return table.Create(request, control(account)).status();
  };
  const auto fork = [&](const std::string& account) {
    v1::ForkSessionRequest request;
    request.set_session_id(table.List(1, "", [](const Session&) { return true; }).sessions[0]->id());
    return table.Fork(request, control(account)).status();
  };
  EXPECT_TRUE(create("anna").ok() && fork("anna").ok());
  for (const absl::Status& refused : {create("anna"), fork("anna")}) {
    EXPECT_TRUE(absl::IsResourceExhausted(refused)) << refused;
    EXPECT_THAT(Message(refused), HasSubstr("--max-vertices"));
  }
  EXPECT_TRUE(create("ben").ok() && fork("ben").ok());
  EXPECT_TRUE(absl::IsResourceExhausted(create("cleo")));
  EXPECT_EQ(table.List(16, "", [](const Session&) { return true; }).sessions.size(), 4u) << "a refused one is there";
}

TEST_F(TableTest, ASessionThatCannotBeCreatedLeavesItsIdFree) {
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(absl::IsNotFound(Create("x", "thorux").status()));
  EXPECT_TRUE(Create("x").ok());
}

TEST_F(TableTest, AnUnknownSessionIsNotFoundAndTheErrorListsTheOthers) {
  ASSERT_TRUE(Create("mine").ok());
  const auto missing = table_.Find("yours");
  EXPECT_TRUE(absl::IsNotFound(missing.status()));
  EXPECT_THAT(Message(missing.status()), HasSubstr("there are mine"));
  EXPECT_TRUE(absl::IsNotFound(table_.Delete("yours")));
}

TEST_F(TableTest, PagesListEverySessionOnce) {
  for (const char* id : {"c", "a", "d", "b"}) ASSERT_TRUE(Create(id).ok());
  std::string seen, token;
  do {
    const Table::Page page = table_.List(3, token);
    for (const auto& session : page.sessions) seen += session->id();
    token = page.last;
  } while (!token.empty());
  EXPECT_EQ(seen, "abcd");
}

TEST_F(TableTest, ParametersOfTheRequestOverrideThoseOfTheScene) {
  v1::CreateSessionRequest request;
  *request.mutable_source() = Named("triangle");
  request.mutable_parameters()->set_breath_force(2);
  const auto session = table_.Create(request);
  ASSERT_TRUE(session.ok()) << session.status();
  EXPECT_EQ((*session)->status().parameters().breath_force(), 2);
  EXPECT_EQ((*session)->status().parameters().time_step(), 0.01);
}

TEST_F(TableTest, AForkStartsAtTheOtherSessionsStateAndIsIndependentOfIt) {
  const auto session = *Create("mine");
  const auto step = [](Session& which) { return which.Step(5, std::nullopt, [] { return false; })->state_hash; };
  step(*session);
  v1::ForkSessionRequest request;
  request.set_session_id("mine");
  const auto fork = table_.Fork(request);
  ASSERT_TRUE(fork.ok()) << fork.status();
  EXPECT_EQ((*fork)->id(), "triangle");
  EXPECT_EQ((*fork)->status().tick(), 5);
  EXPECT_EQ((*fork)->status().largest_stable_step(), session->status().largest_stable_step());
  v1::Parameters stiffer;
  stiffer.set_elasticity(2);
  ASSERT_TRUE(session->Update(stiffer, std::nullopt).ok());
  const std::string alone = step(**fork);
  EXPECT_NE(alone, step(*session));
  request.set_fork_id("mine");
  EXPECT_TRUE(absl::IsAlreadyExists(table_.Fork(request).status()));
  request.set_session_id("nobody");
  EXPECT_TRUE(absl::IsNotFound(table_.Fork(request).status()));
}

TEST_F(TableTest, DeleteEndsTheViewers) {
  const auto session = Create("mine");
  ASSERT_TRUE(session.ok());
  const auto viewer = (*session)->publisher().Join({}, [] {});
  ASSERT_TRUE(viewer.ok());
  ASSERT_TRUE(table_.Delete("mine").ok());
  while ((*viewer)->Take(absl::Now()) != nullptr) continue;
  ASSERT_TRUE((*viewer)->ended().has_value());
  EXPECT_TRUE(absl::IsNotFound(*(*viewer)->ended()));
}

TEST_F(TableTest, NoSessionIsCreatedAfterClose) {
  ASSERT_TRUE(Create("mine").ok());
  table_.Close(absl::UnavailableError("the server is shutting down"));
  EXPECT_TRUE(absl::IsUnavailable(Create("yours").status()));
  EXPECT_TRUE(absl::IsNotFound(table_.Find("mine").status()));
}

class TendedTable : public FolderTest {
 protected:
  std::shared_ptr<Session> Play(const std::string& id) {
    v1::CreateSessionRequest request;
    request.set_session_id(id);
    request.mutable_source()->set_name("triangle");
    auto session = table_.Create(request);
    EXPECT_TRUE(session.ok()) << session.status();
    EXPECT_TRUE((*session)->Play(std::nullopt, false, 0).ok());
    return *session;
  }
  static bool Plays(const Session& session) { return session.status().state() == v1::SESSION_STATE_PLAYING; }

  FakeClock clock_;
  Models models_{Catalogue(), "", 4};
  Table table_{models_, clock_, {.sessions = 2000, .pause_minutes = 10, .delete_minutes = 30}};
};

TEST_F(TendedTable, ASessionWithoutViewersOrCallsIsPausedAndThenDeleted) {
  const auto left = Play("left"), asked = Play("asked");
  clock_.Advance(absl::Minutes(9));
  ASSERT_TRUE(table_.Find("asked").ok());
  table_.Tend();
  EXPECT_TRUE(Plays(*left) && Plays(*asked));
  clock_.Advance(absl::Minutes(2));
  table_.Tend();
  EXPECT_FALSE(Plays(*left));
  EXPECT_TRUE(Plays(*asked)) << "somebody asked for it";
  clock_.Advance(absl::Minutes(20));
  table_.Tend();
  EXPECT_TRUE(absl::IsNotFound(table_.Find("left").status()));
  EXPECT_TRUE(table_.Find("asked").ok());
}

TEST_F(TendedTable, EverySessionIsTendedHoweverManyThereAre) {
  for (int i = 0; i < 1010; ++i) {  // a page of List has at most 1,000
    v1::CreateSessionRequest request;
    request.set_session_id("s" + std::to_string(i));
    request.mutable_source()->set_name("triangle");
    ASSERT_TRUE(table_.Create(request).ok());
  }
  clock_.Advance(absl::Minutes(31));
  table_.Tend();
  EXPECT_TRUE(table_.List(10, "").sessions.empty());
}

TEST_F(TendedTable, AWatchedSessionContinues) {
  const auto watched = Play("watched");
  const auto viewer = watched->publisher().Join({}, [] {});
  ASSERT_TRUE(viewer.ok());
  for (int i = 0; i < 10; ++i) {
    clock_.Advance(absl::Minutes(9));
    table_.Tend();
    ASSERT_TRUE(Plays(*watched));
  }
  watched->publisher().Leave(*viewer);
  clock_.Advance(absl::Minutes(11));
  table_.Tend();
  EXPECT_FALSE(Plays(*watched));
}

TEST_F(TendedTable, ASessionThatWasAskedToKeepPlayingContinues) {
  const auto kept = Play("kept"), until = Play("until");
  ASSERT_TRUE(kept->Play(PlayRequest{.keep_playing = true}, "").ok());
  ASSERT_TRUE(until->Play(PlayRequest{.until = 1e6}, "").ok());
  clock_.Advance(absl::Minutes(29));
  table_.Tend();
  EXPECT_TRUE(Plays(*kept) && Plays(*until));
  ASSERT_TRUE(kept->Pause().ok());
  ASSERT_TRUE(kept->Play(PlayRequest{}, "").ok());
  EXPECT_FALSE(kept->status().keep_playing()) << "it was asked once";
}

TEST_F(TendedTable, ACopyForAComparisonEndsWithIt) {
  const auto session = Play("original");
  v1::ForkSessionRequest fork;
  fork.set_session_id("original");
  fork.set_fork_id("copy");
  fork.set_temporary(true);
  const auto copy = table_.Fork(fork);
  ASSERT_TRUE(copy.ok()) << copy.status();
  const auto viewer = (*copy)->publisher().Join({}, [] {});
  ASSERT_TRUE(viewer.ok());
  clock_.Advance(absl::Minutes(3));
  table_.Tend();
  EXPECT_TRUE((*copy)->status().temporary());
  ASSERT_EQ(table_.List(10, "").sessions.size(), 2u) << "it is watched";
  (*copy)->publisher().Leave(*viewer);
  clock_.Advance(absl::Minutes(1.1));
  table_.Tend();
  ASSERT_EQ(table_.List(10, "").sessions.size(), 1u);
  EXPECT_TRUE(table_.Find("original").ok());
}

TEST(TendedTableByDefault, AnUnwatchedSessionIsPausedWithinMinutes) {
  EXPECT_GT(Limits().pause_minutes, 0);
  EXPECT_LE(Limits().pause_minutes, 5);
}

TEST_F(TendedTable, TheNumberOfSessionsOfAnAccountIsBounded) {
  Table table(models_, clock_, {.sessions_of_user = 1});
  const auto make = [&](const std::string& account) {
    v1::CreateSessionRequest request;
    request.mutable_source()->set_name("triangle");
    return table.Create(request, *ControlBook::Make(v1::CONTROL_POLICY_EVERYBODY, "", account)).status();
  };
  EXPECT_TRUE(make("anna").ok());
  const absl::Status second = make("anna");
  EXPECT_TRUE(absl::IsResourceExhausted(second));
  EXPECT_THAT(Message(second), HasSubstr("--max-sessions-of-user"));
  EXPECT_TRUE(make("bert").ok());
  EXPECT_TRUE(make("").ok()) << "of nobody";
  EXPECT_TRUE(make("").ok());
}

}  // namespace
}  // namespace phrenic::session
