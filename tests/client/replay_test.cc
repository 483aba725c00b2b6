// `phrenic replay`, `phrenic run --dry-run`, and JUnit reports.
#include <gmock/gmock.h>

#include <filesystem>

#include "tests/client/programs.h"

namespace phrenic::client {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// Writes the JSON output of a run of a cube, after `change` modified it. Returns the file.
template <typename Change>
std::string RecordedCube(Change change) {
  const Outcome run = Phrenic({"run", "cube-tensegrity", "--seconds", "0.5", "--set", "elasticity=1.5", "-o", "json"});
  EXPECT_EQ(run.code, 0) << run.err;
  nlohmann::json json = run.json();
  change(json);
  return WriteScratch("recorded.json", json.dump());
}

TEST(Replay, EndsInTheSameStateToTheLastBit) {
  const std::string file = RecordedCube([](nlohmann::json&) {});
  const Outcome again = Phrenic({"replay", file});
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_THAT(again.out, HasSubstr("100 steps: state hash "));
  EXPECT_THAT(again.out, HasSubstr("equal to the recorded one"));
  EXPECT_EQ(Phrenic({"replay", file, "-o", "json"}).json()["same"], true);
}

TEST(Replay, OfAnotherStateHasExitCodeFour) {
  const auto softer = [](nlohmann::json& json) { json["session"]["parameters"]["elasticity"] = 1.4; };
  const Outcome again = Phrenic({"replay", RecordedCube(softer)});
  EXPECT_EQ(again.code, 4) << again.err;
  EXPECT_THAT(again.out, HasSubstr("not equal to the recorded "));
}

TEST(Replay, OfAnotherSceneIsRejected) {
  const auto other = [](nlohmann::json& json) { json["report"]["scene_hash"] = "0123456789abcdef"; };
  const Outcome again = Phrenic({"replay", RecordedCube(other)});
  EXPECT_EQ(again.code, 1);
  EXPECT_THAT(again.err, HasSubstr("the scene differs from the recorded one"));
  EXPECT_THAT(again.err, HasSubstr("--scene"));
}

TEST(Replay, OfAnInvalidRecordNamesTheCommandThatWritesOne) {
  for (const char* text : {"", "{", "[]", "{\"session\": {}}", "{\"session\": 3, \"state_hash\": 4}"}) {
    const Outcome again = Phrenic({"replay", WriteScratch("bad.json", text)});
    EXPECT_EQ(again.code, 2) << text;
    EXPECT_THAT(again.err, HasSubstr("phrenic run ... -o json")) << text;
  }
  const Outcome wrong = Phrenic({"replay", RecordedCube([](nlohmann::json& json) { json["session"]["tick"] = "x"; })});
  EXPECT_EQ(wrong.code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("session: "));
  EXPECT_THAT(Phrenic({"replay", Scratch("missing.json")}).err, HasSubstr("cannot read the recorded run"));
}

TEST(DryRun, PrintsThePlanAndWritesNothing) {
  const std::string file = Scratch("dry.msh");
  const Outcome dry = Phrenic({"run", "cube-tensegrity", "--seconds", "1", "--export", file, "--dry-run"});
  EXPECT_EQ(dry.code, 0) << dry.err;
  EXPECT_THAT(dry.out, HasSubstr("would take 200 steps of 5 ms"));
  EXPECT_THAT(dry.out, HasSubstr("would write " + file));
  EXPECT_FALSE(std::filesystem::exists(file));
  const auto json = Phrenic({"run", "cube-tensegrity", "--seconds", "1", "--dry-run", "-o", "json"}).json();
  EXPECT_EQ(json["steps"], 200);
  EXPECT_EQ(json["session"]["tick"], "0");
}

TEST(JUnit, HasACasePerLimitAndAFailurePerExceededLimit) {
  const std::string square = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const std::string here = WriteScratch("here.obj", square);
  const std::string there = WriteScratch("there.obj", "v 0 0 2\nv 1 0 2\nv 0 1 2\nf 1 2 3\n");
  const std::string report = Scratch("judged.xml");
  const Outcome judged = Phrenic({"compare", here, there, "--check", "hd_max=1,assd=3", "--junit", report});
  EXPECT_EQ(judged.code, 4) << judged.err;
  const std::string xml = ReadAll(report);
  EXPECT_THAT(xml, HasSubstr("tests=\"2\" failures=\"1\""));
  EXPECT_THAT(xml, HasSubstr("name=\"hd_max\""));
  EXPECT_THAT(xml, HasSubstr("message=\"hd_max is 2 mm; the limit is at most 1\""));
  EXPECT_THAT(xml, HasSubstr("name=\"assd\" />"));
  const Outcome met = Phrenic({"compare", here, there, "--check", "hd_max=3", "--junit", report});
  EXPECT_EQ(met.code, 0) << met.err;
  EXPECT_THAT(ReadAll(report), Not(HasSubstr("<failure")));
}

}  // namespace
}  // namespace phrenic::client
