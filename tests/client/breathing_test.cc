// Presets and `phrenic physiology`, on a coarse thorax for speed.
#include <gmock/gmock.h>

#include "tests/client/programs.h"

namespace phrenic::client {
namespace {

using ::testing::HasSubstr;

TEST(Presets, AreListedAndRun) {
  const Outcome deep =
      Phrenic({"run", "thorax", "--resolution", "20", "--seconds", "0.01", "--preset", "deep", "-o", "json"});
  ASSERT_EQ(deep.code, 0) << deep.err;
  EXPECT_EQ(deep.json()["session"]["parameters"]["breath_length"], 6);
}

TEST(Presets, AreOverriddenBySet) {
  const Outcome both = Phrenic({"run", "thorax", "--resolution", "20", "--seconds", "0.01", "--preset", "deep", "--set",
                                "breath_length=7", "-o", "json"});
  ASSERT_EQ(both.code, 0) << both.err;
  EXPECT_EQ(both.json()["session"]["parameters"]["breath_length"], 7);
  EXPECT_GT(both.json()["session"]["parameters"]["diaphragm_activation"], 0.4);
}

TEST(Presets, UnknownOnesAreRejectedWithTheKnownOnes) {
  const Outcome none = Phrenic({"run", "thorax", "--resolution", "20", "--preset", "snore"});
  EXPECT_EQ(none.code, 2);
  EXPECT_THAT(none.err, HasSubstr("has no preset \"snore\"; there are quiet, upright, deep"));
}

TEST(Physiology, PrintsValueRangeAndVerdict) {
  const Outcome study =
      Phrenic({"physiology", "thorax-thesis", "--resolution", "20", "--preset", "quiet", "-o", "json"});
  ASSERT_EQ(study.code, 0) << study.err;
  const auto rows = study.json()["rows"];
  ASSERT_GE(rows.size(), 30u);
  for (const auto& row : rows) {
    if (row["verdict"] == "VERDICT_NOT_MODELLED") {
      EXPECT_NE(row["note"], "") << row["what"];
      continue;
    }
    if (row["verdict"] == "VERDICT_NOT_JUDGED") continue;
    const bool inside = row["low"] <= row["value"] && row["value"] <= row["high"];
    EXPECT_EQ(row["verdict"], inside ? "VERDICT_INSIDE" : "VERDICT_OUTSIDE") << row["what"];
  }
}

TEST(Physiology, FailsTheCheckIfARowIsOutside) {
  const std::string junit = Scratch("breaths.xml");
  const Outcome study = Phrenic({"physiology", "thorax-thesis", "--resolution", "20", "--preset", "quiet", "--check",
                                 "--junit", junit, "-o", "csv"});
  EXPECT_EQ(study.code, 4) << study.err;
  EXPECT_THAT(study.out, HasSubstr("breath,what,unit,value,low,high,verdict,note,source"));
  EXPECT_THAT(ReadAll(junit), HasSubstr("<failure"));
}

TEST(Physiology, OfASceneWithoutADiaphragmIsRejected) {
  const Outcome cube = Phrenic({"physiology", "cube-springs"});
  EXPECT_EQ(cube.code, 1);
  EXPECT_THAT(cube.err, HasSubstr("STRUCTURE_DIAPHRAGM"));
}

}  // namespace
}  // namespace phrenic::client
