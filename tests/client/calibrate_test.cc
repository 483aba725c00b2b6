// `phrenic calibrate`, on a coarse thorax for speed.
#include <gmock/gmock.h>

#include "tests/client/programs.h"

namespace phrenic::client {
namespace {

using ::testing::HasSubstr;

Outcome Calibrated(std::vector<std::string> more) {
  std::vector<std::string> arguments = {"calibrate", "thorax", "--resolution", "20"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return Phrenic(arguments);
}

// The first breath is near enough: a search of many breaths is in tests/calibrate.
TEST(Calibrate, WritesAPresetThatCanBePastedIntoTheScene) {
  const std::string out = Scratch("preset.textproto");
  const Outcome found = Calibrated({"--preset", "quiet", "--vary", "diaphragm_activation:0.01:1", "--tidal-volume",
                                    "0.5", "--tolerance", "0.5", "--out", out, "-o", "json"});
  ASSERT_EQ(found.code, 0) << found.err;
  const auto json = found.json();
  EXPECT_EQ(json["reached"], true);
  EXPECT_EQ(json["breaths"], 1);
  EXPECT_NEAR(json["measures"][0]["got"], 0.5, 0.5 * 0.5);
  EXPECT_EQ(json["preset"], ReadAll(out));
  EXPECT_THAT(ReadAll(out), HasSubstr("# phrenic calibrate thorax --resolution 20 --preset quiet --vary "
                                      "diaphragm_activation:0.01:1 --tidal-volume 0.5 --tolerance 0.5\npresets {\n"
                                      "  name: \"quiet\"\n"));
  const std::string value = json["parameters"][0]["value"].dump();
  EXPECT_THAT(ReadAll(out), HasSubstr("diaphragm_activation: " + value));
}

TEST(Calibrate, PrintsTheNearestBreathAndWritesNothingIfItIsNotReached) {
  const std::string out = Scratch("unreached.textproto");
  const Outcome found = Calibrated(
      {"--vary", "diaphragm_activation:0:0.1", "--tidal-volume", "3", "--tries", "2", "--out", out, "-o", "csv"});
  EXPECT_EQ(found.code, 4);
  EXPECT_THAT(found.err, HasSubstr("not reached: the limit of 2 breaths ended the search"));
  EXPECT_THAT(found.out, HasSubstr("kind,name,unit,value,wanted,deviation,start,low,high\nparameter,diaphragm_"));
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(Calibrate, InvalidOptionsAreUsageErrorsThatNameTheOption) {
  const auto expect = [](std::vector<std::string> more, const std::string& text) {
    const Outcome outcome = Calibrated(std::move(more));
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(text));
    EXPECT_EQ(outcome.out, "");
  };
  expect({}, "--tidal-volume");
  expect({"--tidal-volume", "0.5"}, "2 parameters are varied for 1 measure");
  expect({"--tidal-volume", "-1"}, "--tidal-volume");
  expect({"--tidal-volume", "nan"}, "--tidal-volume");
  expect({"--vary", "snoring", "--tidal-volume", "0.5"}, "there is no parameter \"snoring\"");
  expect({"--vary", "diaphragm_activation:2:1", "--tidal-volume", "0.5"}, "--vary");
  expect({"--tolerance", "0", "--tidal-volume", "0.5"}, "--tolerance");
  expect({"--tries", "0", "--tidal-volume", "0.5"}, "--tries");
}

TEST(Calibrate, AnUnknownPresetIsAnsweredWithTheKnownOnes) {
  const Outcome outcome = Calibrated({"--preset", "snore", "--tidal-volume", "0.5", "--abdominal-share", "0.6"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("quiet"));
}

}  // namespace
}  // namespace phrenic::client
