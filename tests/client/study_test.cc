// `phrenic study` in this process and on a server, as scripts use it.
#include <gmock/gmock.h>

#include <algorithm>
#include <set>
#include <sstream>
#include <tuple>

#include "tests/client/programs.h"

namespace phrenic::client {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::vector<std::string> kQuick = {"study",    "error", "cube-tensegrity", "--seconds",      "0.5",
                                         "--levels", "3",     "--integrators",   "velocity_verlet"};

Outcome Quick(std::vector<std::string> more) {
  std::vector<std::string> arguments = kQuick;
  arguments.insert(arguments.end(), more.begin(), more.end());
  return Phrenic(arguments);
}

std::string Limit(const std::string& at_most) {
  return "limits { table: \"rows\" where: \"integrator=velocity_verlet\" column: \"error_max_mm\" at_most: " + at_most +
         " }";
}

TEST(StudyError, PrintsATableAndAdvice) {
  const Outcome study = Quick({});
  ASSERT_EQ(study.code, 0) << study.err;
  EXPECT_THAT(study.out, HasSubstr("reference: CVODE"));
  EXPECT_THAT(study.out, HasSubstr("velocity_verlet"));
  EXPECT_THAT(study.out, HasSubstr("For an error of 0.1 mm"));
}

TEST(StudyError, IsJsonWithEveryRow) {
  const Outcome study = Quick({"-o", "json"});
  ASSERT_EQ(study.code, 0) << study.err;
  const auto rows = study.json()["error"]["rows"];
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_NEAR(rows[1]["order"], 2, 0.1);
  EXPECT_EQ(study.json()["scene"], "cube-tensegrity");
}

TEST(StudyError, IsCsvWithAsManyCellsInEachLineOfATable) {
  const Outcome study = Quick({"-o", "csv"});
  ASSERT_EQ(study.code, 0) << study.err;
  EXPECT_THAT(study.out, StartsWith("integrator,time_step_s,error_max_mm"));
  std::istringstream lines(study.out.substr(0, study.out.find("\n\n")));
  std::set<long> commas;
  for (std::string line; std::getline(lines, line);) commas.insert(std::count(line.begin(), line.end(), ','));
  EXPECT_EQ(commas.size(), 1u);
}

TEST(StudyError, IsCheckedAgainstLimits) {
  EXPECT_EQ(Quick({"--check", WriteScratch("wide.textproto", Limit("1e3"))}).code, 0);
  const Outcome exceeded = Quick({"--check", WriteScratch("tight.textproto", Limit("1e-9"))});
  EXPECT_EQ(exceeded.code, 4);
  EXPECT_THAT(exceeded.err, HasSubstr("rows.error_max_mm where integrator=velocity_verlet (row 1) is"));
}

TEST(StudyError, InvalidLimitsAreRejected) {
  const Outcome no_file = Quick({"--check", "/nowhere/limits.textproto"});
  EXPECT_EQ(no_file.code, 1);
  EXPECT_THAT(no_file.err, HasSubstr("/nowhere/limits.textproto"));
  const Outcome no_table = Quick({"--check", WriteScratch("a.textproto", R"(limits { table: "cows" column: "x" })")});
  EXPECT_EQ(no_table.code, 2);
  EXPECT_THAT(no_table.err, HasSubstr("no table \"cows\""));
  const Outcome typo = Quick({"--check", WriteScratch("b.textproto", R"(limits { tabel: "rows" })")});
  EXPECT_THAT(typo.err, HasSubstr("b.textproto:1:"));
  const Outcome none = Quick({"--check", WriteScratch("c.textproto", R"(
    limits { table: "rows" where: "integrator=bdf2" column: "error_max_mm" at_most: 1 })")});
  EXPECT_EQ(none.code, 4);
  EXPECT_THAT(none.err, HasSubstr("no row meets these conditions"));
}

TEST(StudyError, InvalidOptionsAreUsageErrors) {
  for (const auto& [option, value, words] :
       {std::tuple{"--levels", "99", "outside 1 to 16"}, {"--integrators", "magic", "there are semi_implicit_euler"}}) {
    const Outcome bad = Phrenic({"study", "error", "cube-tensegrity", option, value});
    EXPECT_EQ(bad.code, 2);
    EXPECT_THAT(bad.err, HasSubstr(words));
  }
  EXPECT_EQ(Phrenic({"study", "error", "no-such-scene"}).code, 1);
}

TEST(Study, ContinuesOnTheServerWithoutItsClient) {
  const RunningServer server;
  ASSERT_NE(server.port(), 0) << server.output();
  const auto ask = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"--server", server.address()});
    return Phrenic(arguments);
  };
  std::vector<std::string> detached = kQuick;
  detached.insert(detached.end(), {"--id", "mine", "--detach"});
  const Outcome started = ask(detached);
  ASSERT_EQ(started.code, 0) << started.err;
  EXPECT_EQ(started.out, "mine\n");
  const Outcome watched = ask({"study", "watch", "mine", "-o", "json"});
  ASSERT_EQ(watched.code, 0) << watched.err;
  EXPECT_EQ(watched.json()["error"]["rows"].size(), 3u);
  const Outcome listed = ask({"study", "list", "-o", "json"});
  EXPECT_EQ(listed.json()["studies"][0]["state"], "STUDY_STATE_DONE") << listed.out;
  EXPECT_EQ(ask({"study", "delete", "mine"}).code, 0);
  const Outcome gone = ask({"study", "watch", "mine"});
  EXPECT_EQ(gone.code, 1);
  EXPECT_THAT(gone.err, HasSubstr("there is no study \"mine\""));
}

}  // namespace
}  // namespace phrenic::client
