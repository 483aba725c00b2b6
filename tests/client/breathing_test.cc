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
  EXPECT_EQ(deep.json()["session"]["parameters"]["breath_length"], 8);
}

TEST(Presets, AreOverriddenBySet) {
  const Outcome both = Phrenic({"run", "thorax", "--resolution", "20", "--seconds", "0.01", "--preset", "deep", "--set",
                                "breath_length=6", "-o", "json"});
  ASSERT_EQ(both.code, 0) << both.err;
  EXPECT_EQ(both.json()["session"]["parameters"]["breath_length"], 6);
  EXPECT_GT(both.json()["session"]["parameters"]["rib_motion"], 1);
}

TEST(Presets, UnknownOnesAreRejectedWithTheKnownOnes) {
  const Outcome none = Phrenic({"run", "thorax", "--resolution", "20", "--preset", "snore"});
  EXPECT_EQ(none.code, 1);
  EXPECT_THAT(none.err, HasSubstr("has no preset \"snore\"; there are quiet, deep, diaphragmatic, chest"));
}

TEST(Physiology, PrintsValueRangeAndVerdict) {
  const Outcome study = Phrenic({"physiology", "thorax", "--resolution", "20", "-o", "json"});
  ASSERT_EQ(study.code, 0) << study.err;
  const auto rows = study.json()["rows"];
  ASSERT_GE(rows.size(), 19u);
  for (const auto& row : rows) {
    const bool inside = row["low"] <= row["value"] && row["value"] <= row["high"];
    EXPECT_EQ(row["verdict"], inside ? "VERDICT_INSIDE" : "VERDICT_OUTSIDE") << row["what"];
  }
}

TEST(Physiology, OfASceneWithoutADiaphragmIsRejected) {
  const Outcome cube = Phrenic({"physiology", "cube-springs"});
  EXPECT_EQ(cube.code, 1);
  EXPECT_THAT(cube.err, HasSubstr("STRUCTURE_DIAPHRAGM"));
}

}  // namespace
}  // namespace phrenic::client
