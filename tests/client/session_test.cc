// The commands for sessions of a running server.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>

#include "tests/client/programs.h"

namespace phrenic::client {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class Sessions : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_NE(server_.port(), 0) << server_.output(); }

  Outcome Ask(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"--server", server_.address()});
    return Phrenic(arguments);
  }
  // The answer as JSON; the command must succeed.
  nlohmann::json Json(std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"-o", "json"});
    const Outcome outcome = Ask(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_FALSE(outcome.json().is_discarded()) << outcome.out;
    return outcome.json();
  }

  RunningServer server_;
};

TEST_F(Sessions, ScenesAreListed) {
  const Outcome table = Ask({"scenes"});
  EXPECT_EQ(table.code, 0) << table.err;
  for (const char* scene : {"cube-springs", "cube-tensegrity", "sheet-2d", "thorax"}) {
    EXPECT_THAT(table.out, HasSubstr(scene));
  }
  EXPECT_GE(Json({"scenes"})["scenes"].size(), 5U);
}

TEST_F(Sessions, DescribePrintsWhatRunsAndTheLargestStableStep) {
  const Outcome table = Ask({"describe", "cube-tensegrity"});
  ASSERT_EQ(table.code, 0) << table.err;
  for (const char* words : {"What runs", "What was left out", "12 springs", "Largest stable step", "breath_force"}) {
    EXPECT_THAT(table.out, HasSubstr(words));
  }
  const auto json = Json({"describe", "cube-tensegrity"});
  EXPECT_EQ(json["report"]["springs"], "12");
  EXPECT_GT(json["report"]["stable_step"]["seconds"].get<double>(), 0);
}

TEST_F(Sessions, OpenInABrowserByTheirLink) {
  const std::string opened = Scratch("opened"), browser = WriteScratch("browser", "#!/bin/sh\necho \"$1\" > " + opened);
  std::filesystem::permissions(browser, std::filesystem::perms::owner_all);
  setenv("BROWSER", browser.c_str(), 1);
  const auto created = Json({"create", "cube-springs", "--id", "seen", "--web"});
  unsetenv("BROWSER");
  const std::string link = created["viewer"];
  EXPECT_THAT(link, HasSubstr("?session=seen"));
  for (int i = 0; i < 500 && ReadAll(opened).empty(); ++i) usleep(20'000);
  EXPECT_EQ(ReadAll(opened), link + "\n");
  setenv("BROWSER", "no-such-browser", 1);
  const std::string path = getenv("PATH");
  setenv("PATH", Scratch("").c_str(), 1);
  const Outcome outcome = Ask({"create", "cube-springs", "--id", "unseen", "--web"});
  setenv("PATH", path.c_str(), 1);
  unsetenv("BROWSER");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, testing::AllOf(HasSubstr("xdg-open"), HasSubstr("?session=unseen")));
}

TEST_F(Sessions, ASessionLivesFromCreateToDelete) {
  EXPECT_EQ(Json({"create", "cube-springs", "--id", "one", "--set", "breath_force=2"})["session"]["id"], "one");
  EXPECT_EQ(Json({"sessions"})["sessions"].size(), 1U);
  EXPECT_THAT(Ask({"sessions"}).out, HasSubstr("paused"));

  const auto stepped = Json({"step", "one", "10", "--expected-tick", "0"});
  EXPECT_EQ(stepped["session"]["tick"], "10");
  EXPECT_EQ(stepped["state_hash"].get<std::string>().size(), 16U);
  EXPECT_EQ(Ask({"step", "one", "1", "--expected-tick", "0"}).code, 1) << "the session is at tick 10";

  const auto set = Json({"set", "one", "breath_force=1.5", "apply_links=off"});
  EXPECT_EQ(set["session"]["parameters"]["breath_force"], 1.5);
  EXPECT_EQ(set["session"]["parameters"]["apply_links"], false);

  const auto fork = Json({"fork", "one", "--id", "two", "--play"});
  EXPECT_EQ(fork["session"]["id"], "two");
  EXPECT_EQ(fork["session"]["state"], "SESSION_STATE_PLAYING");
  EXPECT_EQ(fork["session"]["parameters"]["breath_force"], 1.5);
  EXPECT_EQ(Ask({"delete", "two"}).code, 0);

  EXPECT_EQ(Json({"play", "one", "--fast"})["session"]["state"], "SESSION_STATE_PLAYING");
  EXPECT_EQ(Json({"pause", "one"})["session"]["state"], "SESSION_STATE_PAUSED");
  EXPECT_EQ(Json({"reset", "one"})["session"]["tick"], "0");
  EXPECT_EQ(Json({"step", "one", "10"})["session"]["tick"], "10");

  EXPECT_EQ(Ask({"delete", "one"}).code, 0);
  EXPECT_EQ(Ask({"delete", "one"}).code, 1);
}

TEST_F(Sessions, AChoiceIsSetAndShownByItsName) {
  ASSERT_EQ(Ask({"create", "cube-springs", "--id", "class"}).code, 0);
  const Outcome set = Ask({"set", "class", "integrator=semi_implicit_euler"});
  ASSERT_EQ(set.code, 0) << set.err;
  EXPECT_THAT(set.out, HasSubstr("integrator=semi_implicit_euler"));
  const auto session = Json({"set", "class", "integrator=Semi-Implicit-Euler"})["session"];
  EXPECT_EQ(session["parameters"]["integrator"], "INTEGRATOR_SEMI_IMPLICIT_EULER");

  const Outcome refused = Ask({"set", "class", "breath_force=2", "integrator=magic"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err,
              HasSubstr("integrator: there is no \"magic\"; did you mean static? There are semi_implicit_euler"));
  EXPECT_EQ(Json({"sessions"})["sessions"][0]["parameters"]["breath_force"], 1) << "the whole change is rejected";
}

TEST_F(Sessions, AVertexIsPulledAndReleased) {
  ASSERT_EQ(Ask({"create", "cube-springs", "--id", "class"}).code, 0);
  const Outcome pulled = Ask({"pull", "class", "--body", "cube", "--vertex", "6", "--force", "-1,0,0.5"});
  ASSERT_EQ(pulled.code, 0) << pulled.err;
  EXPECT_THAT(pulled.out, HasSubstr("pulled by (-1, 0, 0.5) N at vertex 6 of cube"));
  EXPECT_EQ(Json({"sessions"})["sessions"][0]["pulls"][0]["vertex"], 6);
  EXPECT_THAT(Ask({"pull", "class", "--release"}).out, Not(HasSubstr("pulled by")));
  EXPECT_EQ(Ask({"pull", "class", "--vertex", "6"}).code, 2) << "the body is missing";
  EXPECT_EQ(Ask({"pull", "class"}).code, 2);
  EXPECT_THAT(Ask({"create", "cube-springs", "--pull", "cube:6:1,0"}).err, HasSubstr("BODY:VERTEX:X,Y,Z"));
  EXPECT_THAT(Ask({"create", "cube-springs", "--pull", "cube:6:1,0,2"}).out, HasSubstr("pulled by (1, 0, 2) N"));
}

TEST_F(Sessions, ConstraintsAreReportedIfThereAreAny) {
  ASSERT_EQ(Ask({"create", "cube-tensegrity", "--id", "links", "--play"}).code, 0);
  EXPECT_THAT(Ask({"watch", "links", "--count", "2", "--fps", "50"}).out, HasSubstr("constraints within"));
  EXPECT_TRUE(Json({"sessions"})["sessions"][0].contains("constraint_residual"));
  EXPECT_THAT(Ask({"create", "cube-springs"}).out, Not(HasSubstr("constraints")));
  EXPECT_THAT(Ask({"run", "cube-tensegrity", "--seconds", "0.2"}).out, HasSubstr("constraints kept within"));
}

TEST_F(Sessions, WatchPrintsLinesAndEndsAfterCount) {
  ASSERT_EQ(Ask({"create", "cube-springs", "--id", "seen", "--play"}).code, 0);
  const Outcome watched = Ask({"watch", "seen", "--count", "3", "--fps", "50"});
  ASSERT_EQ(watched.code, 0) << watched.err;
  EXPECT_THAT(watched.out, HasSubstr("breath"));
  EXPECT_THAT(watched.out, HasSubstr("p "));
  EXPECT_THAT(watched.out, HasSubstr(" mm"));
  EXPECT_THAT(watched.out, Not(HasSubstr("\x1b"))) << "no control sequences without a terminal";

  const Outcome json = Ask({"watch", "seen", "--count", "2", "-o", "json"});
  std::istringstream lines(json.out);
  int frames = 0;
  for (std::string line; std::getline(lines, line);) {
    const auto event = nlohmann::json::parse(line, nullptr, false);
    ASSERT_FALSE(event.is_discarded()) << line;
    frames += event.contains("frame") ? 1 : 0;
  }
  EXPECT_EQ(frames, 2);
  EXPECT_EQ(Ask({"watch", "seen", "--seconds", "0.3"}).code, 0);
}

TEST_F(Sessions, WatchPrintsEverySampleOfSimulatedTime) {
  ASSERT_EQ(Ask({"create", "hanging-sheet", "--id", "seen", "--set", "time_step=0.0005", "--play"}).code, 0);
  const Outcome csv =
      Ask({"watch", "seen", "--every", "0.01", "--count", "6", "--measure", "energy of the springs", "-o", "csv"});
  ASSERT_EQ(csv.code, 0) << csv.err;
  std::istringstream lines(csv.out);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "time [s],tick,breath,energy of the springs [J]");
  std::vector<int> ticks;
  while (std::getline(lines, line)) ticks.push_back(std::stoi(line.substr(line.find(',') + 1)));
  ASSERT_EQ(ticks.size(), 6u);
  for (std::size_t i = 1; i < ticks.size(); ++i) EXPECT_EQ(ticks[i] - ticks[i - 1], 20);
  EXPECT_THAT(Ask({"watch", "seen", "--every", "0.01", "--measure", "x"}).err, HasSubstr("measures[0]"));
  EXPECT_EQ(Ask({"watch", "seen", "--measure", "x"}).code, 2);
  EXPECT_EQ(Ask({"watch", "seen", "--every", "0.01", "--lungs"}).code, 2);
}

// The session is stepped no further than the last line's sample.
TEST_F(Sessions, WatchEndsWithTheLastLineAlsoIfTheSessionPauses) {
  ASSERT_EQ(Ask({"create", "hanging-sheet", "--id", "seen", "--set", "time_step=0.0005"}).code, 0);
  const std::string out = Scratch("counted.csv"), said = Scratch("counted.err");
  const pid_t client =
      Start("phrenic", {"watch", "seen", "--every", "0.01", "--count", "4", "-o", "csv", "--server", server_.address()},
            out, said);
  const auto lines = [&out] {
    const std::string csv = ReadAll(out);
    return std::count(csv.begin(), csv.end(), '\n');
  };
  for (int i = 0; i < 100 && lines() < 2; ++i) {  // until a header and a sample are there: it watches
    ASSERT_EQ(Ask({"step", "seen", "20"}).code, 0);
    usleep(300'000);
  }
  const auto rest = 5 - lines();
  for (int i = 0; i < rest; ++i) ASSERT_EQ(Ask({"step", "seen", "20"}).code, 0);
  EXPECT_EQ(WaitFor(client), 0) << ReadAll(said);
  EXPECT_EQ(lines(), 5);
}

TEST_F(Sessions, ExportDoesNotChangeTheSession) {
  ASSERT_EQ(Ask({"create", "cube-tensegrity", "--id", "kept"}).code, 0);
  const std::string file = Scratch("kept.depl");
  const auto summary = Json({"export", "kept", file, "--seconds", "1", "--fps", "10"});
  EXPECT_EQ(summary["frames"], "11");
  EXPECT_EQ(summary["bytes"], std::to_string(std::filesystem::file_size(file)));
  EXPECT_EQ(Json({"step", "kept", "1"})["session"]["tick"], "1");
}

TEST_F(Sessions, AnExportContinuesWithoutItsCallerAndADownloadResumes) {
  ASSERT_EQ(Ask({"create", "cube-tensegrity", "--id", "away"}).code, 0);
  const std::string plain = Scratch("plain.msh"), fetched = Scratch("away.msh");
  ASSERT_EQ(Ask({"export", "away", plain, "--seconds", "1"}).code, 0);
  EXPECT_EQ(Json({"exports", "list"})["exports"].size(), 0U) << "a downloaded export is deleted";
  const Outcome detached = Ask({"export", "away", fetched, "--seconds", "1", "--detach"});
  EXPECT_EQ(detached.out, "away\n");
  const std::string whole = ReadAll(plain);
  std::ofstream(fetched + ".part", std::ios::binary) << whole.substr(0, whole.size() / 2);
  ASSERT_EQ(Ask({"exports", "get", "away", fetched}).code, 0);
  EXPECT_EQ(ReadAll(fetched), whole);
  EXPECT_FALSE(std::filesystem::exists(fetched + ".part"));
  EXPECT_EQ(Json({"exports", "list"})["exports"][0]["state"], "EXPORT_STATE_DONE");
  EXPECT_EQ(Ask({"exports", "delete", "away"}).code, 0);
  EXPECT_THAT(Ask({"exports", "get", "away"}).err, HasSubstr("there are none"));
}

TEST_F(Sessions, APvdHasAFolder) {
  ASSERT_EQ(Ask({"create", "cube-tensegrity", "--id", "pvd"}).code, 0);
  const std::string file = Scratch("motion.pvd"), stem = Scratch("motion");
  ASSERT_EQ(Ask({"export", "pvd", file, "--seconds", "0.2"}).code, 0);
  EXPECT_THAT(ReadAll(file), HasSubstr("motion_000002.vtp"));
  EXPECT_TRUE(std::filesystem::exists(stem + "/" + std::filesystem::path(stem).filename().string() + "_000002.vtp"));
  EXPECT_FALSE(std::filesystem::exists(file + ".zip"));
}

TEST_F(Sessions, AnUploadedSurfaceServesScenes) {
  const std::string file = WriteScratch("lung.obj", "v 0 0 0\nv 30 0 0\nv 0 30 0\nf 1 2 3\n");
  const Outcome uploaded = Ask({"upload", file});
  ASSERT_EQ(uploaded.code, 0) << uploaded.err;
  EXPECT_THAT(uploaded.out, testing::MatchesRegex("upload:[0-9a-f]{64}\n"));
  EXPECT_EQ(Ask({"upload", file}).out, uploaded.out) << "the server has it already";
  const std::string scene =
      WriteScratch("own.textproto", "name: 'own' bodies { name: 'a' role: ROLE_DEFORMABLE file { path: '" +
                                        uploaded.out.substr(0, uploaded.out.size() - 1) + "' } }");
  const Outcome created = Ask({"create", scene, "--id", "own"});
  EXPECT_EQ(created.code, 0) << created.err;
  EXPECT_THAT(Ask({"upload", WriteScratch("bad.obj", "v 0 0\n")}).err, HasSubstr("bad.obj:1: "));
}

TEST_F(Sessions, ErrorsNameTheRemedyOnStandardError) {
  ASSERT_EQ(Ask({"create", "cube-springs", "--id", "taken"}).code, 0);
  const struct {
    std::vector<std::string> arguments;
    const char* words;
    int code = 1;
  } lines[] = {
      {{"watch", "nobody"}, "taken"},
      {{"play", "nobody"}, "nobody"},
      {{"export", "nobody", Scratch("x.msh")}, "nobody"},
      {{"create", "cube-springs", "--id", "taken"}, "taken"},
      {{"create", "cube-springs", "--id", "Not An Id"}, "session_id", 2},
      {{"set", "taken", "breath_length=0"}, "breath_length: 0 is outside 0.5 to 30", 2},
      {{"set", "taken", "apply_links=maybe"}, "apply_links", 2},
      {{"step", "taken", "0"}, "ticks", 2},
      {{"export", "taken", Scratch("x.avi")}, "msh, depl", 2},
      {{"describe", "no-such-scene"}, "cube-springs"},
  };
  for (const auto& line : lines) {
    const Outcome outcome = Ask(line.arguments);
    EXPECT_EQ(outcome.code, line.code) << testing::PrintToString(line.arguments);
    EXPECT_THAT(outcome.err, HasSubstr(line.words));
    EXPECT_THAT(outcome.out, IsEmpty());
  }
}

TEST(Unreachable, HasItsOwnExitCodeAndNamesTheRemedy) {
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"sessions"}, {"watch", "one"}, {"export", "one", Scratch("u.msh")}}) {
    std::vector<std::string> arguments = {"--server", "127.0.0.1:1"};
    arguments.insert(arguments.end(), command.begin(), command.end());
    const Outcome outcome = Phrenic(arguments);
    EXPECT_EQ(outcome.code, 3) << command[0];
    EXPECT_THAT(outcome.err, HasSubstr("no server at 127.0.0.1:1"));
    EXPECT_THAT(outcome.err, HasSubstr("deploy/run"));
  }
}

TEST(Unreachable, TheEnvironmentNamesTheServer) {
  setenv("PHRENIC_SERVER", "127.0.0.1:2", 1);
  const Outcome outcome = Phrenic({"sessions"});
  unsetenv("PHRENIC_SERVER");
  EXPECT_THAT(outcome.err, HasSubstr("no server at 127.0.0.1:2"));
}

TEST_F(Sessions, TheOwnerControlsASessionUntilItIsHandedOver) {
  ASSERT_EQ(Ask({"create", "cube-springs", "--id", "mine", "--mine", "--name", "Anna"}).code, 0);
  EXPECT_EQ(Ask({"set", "mine", "breath_force=2"}).code, 0);
  User() = "ben";
  const Outcome refused = Ask({"set", "mine", "breath_force=3"});
  EXPECT_EQ(refused.code, 5);
  EXPECT_THAT(refused.err, HasSubstr("controlled by Anna"));
  EXPECT_THAT(Ask({"control", "release", "mine"}).err, HasSubstr("`phrenic control take mine` first"));
  EXPECT_EQ(Ask({"control", "take", "mine", "--name", "Ben"}).code, 1) << "Ben only asks";
  User() = "anna";
  EXPECT_THAT(Ask({"control", "show", "mine"}).out, HasSubstr("Ben, asks for control"));
  EXPECT_EQ(Ask({"control", "hand", "mine", "Ben"}).code, 0);
  EXPECT_EQ(Ask({"pause", "mine"}).code, 5);
  EXPECT_EQ(Ask({"control", "take", "mine"}).code, 0) << "the owner takes it back";
  EXPECT_EQ(Ask({"control", "lend", "mine"}).code, 0);
  User() = "ben";
  EXPECT_EQ(Ask({"delete", "mine"}).code, 0);
  User() = "anna";
}

TEST_F(Sessions, OnlyTheUserMayReadTokens) {
  namespace fs = std::filesystem;
  const std::string token = Json({"create", "cube-springs", "--id", "kept"})["control_token"];
  const fs::path folder = fs::path(Scratch("anna")) / "phrenic";
  EXPECT_THAT(ReadAll((folder / "control").string()), HasSubstr(" kept " + token + "\n"));
  EXPECT_EQ(fs::status(folder / "control").permissions(), fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_EQ(fs::status(folder).permissions(), fs::perms::owner_all);
  ASSERT_EQ(Ask({"delete", "kept"}).code, 0);
  EXPECT_THAT(ReadAll((folder / "control").string()), Not(HasSubstr(token)));
}

TEST_F(Sessions, ARepeatedRequestIdStepsOnce) {
  ASSERT_EQ(Ask({"create", "cube-springs", "--id", "once"}).code, 0);
  ASSERT_EQ(Ask({"set", "once", "breath_force=3", "--at-tick", "5"}).code, 0);
  const auto first = Json({"step", "once", "10", "--request-id", "a-1"});
  EXPECT_EQ(Json({"step", "once", "10", "--request-id", "a-1"}), first);
  EXPECT_EQ(first["session"]["tick"], "10");
  EXPECT_EQ(first["session"]["parameters"]["breath_force"], 3);
  EXPECT_THAT(Ask({"step", "once", "11", "--request-id", "a-1"}).err, HasSubstr("request_id: a-1"));
}

}  // namespace
}  // namespace phrenic::client
