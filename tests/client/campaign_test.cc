// Campaigns: every combination runs once, even after a kill, and limits are checked.
#include <gmock/gmock.h>

#include <filesystem>
#include <map>

#include "tests/client/programs.h"

namespace phrenic::client {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr char kSweep[] = R"(
  name: "sweep" scenes: "cube-tensegrity" scenes: "cube-springs"
  axes { parameter: "integrator" values: "semi_implicit_euler" values: "velocity_verlet" }
  axes { parameter: "breath_force" values: "0.5" values: "1" values: "2" }
  seconds: 0.5
)";

class Campaigns : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::remove_all(folder_); }

  Outcome Ask(const std::string& verb, const std::string& campaign, std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"campaign", verb, WriteScratch("sweep.textproto", campaign), "--out", folder_});
    return Phrenic(more);
  }
  // Returns each result file's bytes and time of writing.
  std::map<std::string, std::pair<std::string, std::filesystem::file_time_type>> Results() const {
    std::map<std::string, std::pair<std::string, std::filesystem::file_time_type>> results;
    if (!std::filesystem::exists(folder_ + "/cells")) return results;
    for (const auto& file : std::filesystem::directory_iterator(folder_ + "/cells")) {
      if (file.path().extension() != ".json") continue;  // incomplete, if its process was killed
      results[file.path()] = {ReadAll(file.path()), file.last_write_time()};
    }
    return results;
  }

  const std::string folder_ = Scratch("campaign");
};

TEST_F(Campaigns, RunEveryCombinationAsOneRunWould) {
  const Outcome outcome = Ask("run", kSweep, {"--jobs", "2", "-o", "json", "--page", Scratch("page.html")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const nlohmann::json rows = outcome.json()["rows"];
  ASSERT_EQ(rows.size(), 12);
  EXPECT_EQ(rows[4]["settings"], "integrator=velocity_verlet breath_force=1");
  const Outcome alone = Phrenic({"run", "cube-tensegrity", "--seconds", "0.5", "--set", "integrator=velocity_verlet",
                                 "--set", "breath_force=1", "-o", "json"});
  EXPECT_EQ(rows[4]["state_hash"], alone.json()["state_hash"]) << alone.out;
  EXPECT_THAT(ReadAll(Scratch("page.html")), HasSubstr("12 runs of 0.5 s: 12 done"));
}

TEST_F(Campaigns, ResumeAfterCtrlCAndAKillAndRepeatNothing) {
  std::string sweep = kSweep;
  sweep.replace(sweep.find("seconds: 0.5"), 12, "seconds: 60");
  const std::vector<std::string> words = {"campaign", "run", WriteScratch("sweep.textproto", sweep), "--out", folder_};
  for (const int signal : {SIGINT, SIGKILL}) {
    const size_t finished = Results().size();
    const pid_t campaign = Start("phrenic", words, Scratch("out"), Scratch("err"));
    while (Results().size() < finished + 3 && waitpid(campaign, nullptr, WNOHANG) == 0) usleep(2'000);
    kill(campaign, signal);
    int status = 0;
    waitpid(campaign, &status, 0);
    EXPECT_EQ(WIFEXITED(status) ? WEXITSTATUS(status) : 0, signal == SIGINT ? 130 : 0) << ReadAll(Scratch("err"));
  }
  const auto before = Results();
  ASSERT_GE(before.size(), 6);
  const Outcome outcome = Ask("run", sweep);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const auto after = Results();
  EXPECT_EQ(after.size(), 12);
  for (const auto& [file, result] : before) EXPECT_EQ(after.at(file), result) << "computed again";
}

TEST_F(Campaigns, NameTheRunThatExceedsALimit) {
  const std::string limited =
      std::string(kSweep) + "limits { table: 'rows' where: 'scene=cube-springs' column: 'steps' at_most: 1 }";
  const Outcome missed = Ask("run", limited);
  EXPECT_EQ(missed.code, 4) << missed.err;
  EXPECT_THAT(missed.err, HasSubstr("limit exceeded: rows.steps where scene=cube-springs"));
  EXPECT_EQ(Ask("run", kSweep).code, 0) << "changed limits repeat no run";
}

TEST_F(Campaigns, ARejectedRunIsARowAndTheOthersContinue) {
  const Outcome outcome = Ask("run", R"(
    name: "one of them" scenes: "cube-springs" presets: "no such preset" presets: "" seconds: 0.1 )",
                              {"-o", "json"});
  EXPECT_EQ(outcome.code, 1);
  const nlohmann::json rows = outcome.json()["rows"];
  ASSERT_EQ(rows.size(), 2) << outcome.err;
  EXPECT_EQ(rows[0]["outcome"], "failed");
  EXPECT_THAT(rows[0]["why"].get<std::string>(), HasSubstr("no such preset"));
  EXPECT_EQ(rows[1]["outcome"], "done");
}

TEST_F(Campaigns, ARunThatDivergesIsARowAndTheOthersContinue) {
  const Outcome outcome = Ask("run", R"(
    name: "too long" scenes: "pressure-lungs" seconds: 3
    axes { parameter: 'integrator' values: 'explicit_euler' values: 'semi_implicit_euler' }
    axes { parameter: 'time_step' values: '0.1' values: '0.001' } )",
                              {"-o", "json"});
  EXPECT_EQ(outcome.code, 1);
  const nlohmann::json rows = outcome.json()["rows"];
  ASSERT_EQ(rows.size(), 4) << outcome.err;
  EXPECT_EQ(rows[0]["outcome"], "diverged");
  EXPECT_THAT(rows[0]["why"].get<std::string>(), HasSubstr("diverged at"));
  EXPECT_EQ(rows[3]["outcome"], "done");
}

TEST_F(Campaigns, HaveTheSameBitsAtAnyNumberOfThreads) {
  std::map<std::string, std::string> bits;
  for (const char* threads : {"1", "2"}) {
    std::filesystem::remove_all(folder_);
    nlohmann::json result = Ask("run", kSweep, {"--jobs", threads, "-o", "json"}).json();
    for (nlohmann::json& row : result["rows"]) row["cpu_us_a_step"] = row["times_real_time"] = 0;
    bits[threads] = result.dump();
  }
  EXPECT_EQ(bits["1"], bits["2"]);
}

TEST_F(Campaigns, ErrorsNameTheFieldOrTheFile) {
  EXPECT_THAT(Ask("run", "name: 'x' scenes: 'nosuch.textproto'").err, HasSubstr("nosuch.textproto"));
  EXPECT_THAT(Ask("run", "name: 'x' scenes: 'cube-springs' axes { parameter: 'tim_step' values: '1' }").err,
              HasSubstr("tim_step"));
  EXPECT_THAT(Ask("run", "name: 'x' scenes: 'cube-springs' seconds: -1").err, HasSubstr("seconds: -1 is outside"));
  EXPECT_THAT(Ask("work", kSweep, {"--share", "4/3"}).err, HasSubstr("--share"));
  ASSERT_EQ(Ask("run", kSweep).code, 0);
  const std::string broken = Results().begin()->first;
  std::ofstream(broken) << "{";
  const Outcome outcome = Ask("report", kSweep);
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr(broken));
}

// Needs a Slurm cluster; tests/client/slurm/start starts one on this machine.
TEST_F(Campaigns, RunOnSlurm) {
  if (std::system("sinfo --noheader > /dev/null 2>&1") != 0) GTEST_SKIP() << "Slurm does not run here";
  const Outcome outcome = Ask("run", kSweep, {"--on", "slurm", "--jobs", "2", "-o", "json"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.json()["rows"].size(), 12);
}

}  // namespace
}  // namespace phrenic::client
