// Readers of recordings and markers: what they find, and what they refuse.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/fit/markers.h"
#include "server/fit/traces.h"

namespace phrenic::fit {
namespace {

using testing::HasSubstr;

// Breaths of irregular length about 4 s, with a pause, on a drifting level.
std::string TraceText(const std::string& header, double time_scale, double scale, double drift = 0.01) {
  std::string text = header + "\n";
  double start = -1.3, length = 4;
  for (int i = 0, breath = 0; i < 1200; ++i) {
    const double t = 0.05 * i;
    if (t >= start + length) {
      start += length;
      length = 4 + 0.6 * std::sin(2.4 * ++breath);
    }
    const double part = std::min(1.0, 1.2 * (t - start) / length);
    const double value = 0.5 * (1 - std::cos(2 * std::numbers::pi * part)) / 2;
    absl::StrAppend(&text, t * time_scale, ",", scale * (value + 2 + drift * t), "\n");
  }
  return text;
}

std::string TraceFault(const std::string& text, Traced traced = Traced::kVolume) {
  return std::string(ParseTrace(traced, "a.csv", text).status().message());
}

TEST(Traces, HaveTheirWholeBreathsWithoutDrift) {
  const auto breaths = ParseTrace(Traced::kVolume, "a.csv", TraceText("time_s,volume_l", 1, 1));
  ASSERT_TRUE(breaths.ok()) << breaths.status();
  EXPECT_GE(breaths->lengths.size(), 12);
  EXPECT_NEAR(breaths->lengths.mean(), 4, 0.15);
  EXPECT_NEAR(breaths->value.maxCoeff(), 0.5e-3, 0.03e-3);
  EXPECT_NEAR(breaths->value.minCoeff(), 0, 0.02e-3);
  EXPECT_GE(breaths->phase.minCoeff(), 0);
  EXPECT_LT(breaths->phase.maxCoeff(), 1);
  EXPECT_TRUE(breaths->doubts.empty());
}

TEST(Traces, InOtherNamedUnitsAreTheSame) {
  const auto litres = ParseTrace(Traced::kVolume, "a.csv", TraceText("time,volume", 1, 1));
  const auto small = ParseTrace(Traced::kVolume, "a.csv", TraceText("Time_ms, Volume_ml", 1000, 1000));
  ASSERT_TRUE(litres.ok() && small.ok()) << small.status();
  ASSERT_EQ(small->value.size(), litres->value.size());
  EXPECT_LT((small->value - litres->value).cwiseAbs().maxCoeff(), 1e-6);
  const auto mm = ParseTrace(Traced::kDisplacement, "a.csv", TraceText("time_s,displacement_mm", 1, 40));
  const auto cm = ParseTrace(Traced::kDisplacement, "a.csv", TraceText("time_s,displacement_cm", 1, 4));
  ASSERT_TRUE(mm.ok() && cm.ok()) << mm.status() << cm.status();
  EXPECT_LT((mm->value - cm->value).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_NEAR(mm->value.maxCoeff(), 0.02, 0.002);
}

TEST(Traces, InWrongUnitsAreRefusedOrDoubted) {
  EXPECT_THAT(TraceFault(TraceText("time_s,volume_l", 1, 1000)), HasSubstr("call its column volume_ml"));
  EXPECT_THAT(TraceFault(TraceText("time_s,volume_l", 1, 0.001)), HasSubstr("if it is in m^3, multiply it by 1000"));
  EXPECT_THAT(TraceFault(TraceText("time_s,volume_l", 1000, 1)), HasSubstr("call the column time_ms"));
  EXPECT_THAT(TraceFault(TraceText("time_s,volume_l", 1.0 / 60, 1)), HasSubstr("times must be in s"));
  EXPECT_THAT(TraceFault(TraceText("time_s,displacement_mm", 1, 0.04), Traced::kDisplacement),
              HasSubstr("if in m, multiply it by 1000"));
  const auto doubtful = ParseTrace(Traced::kDisplacement, "a.csv", TraceText("time_s,displacement_mm", 1, 4));
  ASSERT_TRUE(doubtful.ok()) << doubtful.status();
  ASSERT_EQ(doubtful->doubts.size(), 1u);
  EXPECT_THAT(doubtful->doubts[0], HasSubstr("displacement_cm"));
}

TEST(Traces, AreRefusedWithTheLineAndTheRemedy) {
  EXPECT_THAT(TraceFault(""), HasSubstr("its first one names the columns"));
  EXPECT_THAT(TraceFault("t,v\n1,2\n"), HasSubstr("a.csv:1: the first line must name the columns time_s and volume_l"));
  EXPECT_THAT(TraceFault("time_s,volume_l\n1,2\n1,3\n"), HasSubstr("a.csv:3: the times must ascend"));
  EXPECT_THAT(TraceFault("time_s,volume_l\n1,x\n"),
              HasSubstr("a.csv:2: \"x\" in column 2, \"volume_l\", is not a finite"));
  EXPECT_THAT(TraceFault("time_s,volume_l\n1\n"), HasSubstr("a.csv:2: column 2, \"volume_l\", is missing"));
  EXPECT_THAT(TraceFault("time_s,volume_l\n1,2\n"), HasSubstr("no whole breath"));
  std::string rising = "time_s,volume_l\n";
  for (int i = 0; i < 100; ++i) absl::StrAppend(&rising, i, ",", 0.1 * i, "\n");
  EXPECT_THAT(TraceFault(rising), HasSubstr("no whole breath"));
}

// Forty minutes at 8 Hz: more samples than a fit uses, and 32 a breath.
TEST(Traces, OfManyBreathsAreThinnedAfterTheyAreCounted) {
  std::string text = "time_s,volume_l\n";
  for (int i = 0; i < 20000; ++i) {
    absl::StrAppendFormat(&text, "%.3f,%.5f\n", i / 8.0, 0.25 * (1 - std::cos(std::numbers::pi * i / 16)));
  }
  const auto breaths = ParseTrace(Traced::kVolume, "a.csv", text);
  ASSERT_TRUE(breaths.ok()) << breaths.status();
  EXPECT_GT(breaths->lengths.size(), 600);
  EXPECT_LE(breaths->phase.size(), 4000);
}

std::string MarkerFault(const std::string& text) { return std::string(ParseMarkers("m.csv", text).status().message()); }

constexpr char kMarkerHeader[] = "name,rest_x,rest_y,rest_z,moved_x,moved_y,moved_z\n";

TEST(MarkerFiles, OfPairsAndOfTracksAreTheSameMotion) {
  const std::string rows = "a,0,-100,0,0,-106,3\nb,100,0,0,104,0,0\nc,-100,0,0,-104,0,0\n";
  const auto pairs = ParseMarkers("m.csv", kMarkerHeader + rows);
  ASSERT_TRUE(pairs.ok()) << pairs.status();
  EXPECT_EQ(pairs->names[1], "b");
  EXPECT_TRUE(pairs->motion.col(0).isApprox(Eigen::Vector3d(0, -0.006, 0.003), 1e-9));
  std::string tracks = "frame,a_x,a_y,a_z,b_x,b_y,b_z,c_x,c_y,c_z\n";
  for (int i = 0; i < 200; ++i) {
    const double s = i % 20 < 10 ? 0 : 1;
    absl::StrAppend(&tracks, i, ",0,", -100 - 6 * s, ",", 3 * s, ",", 100 + 4 * s, ",0,0,", -100 - 4 * s, ",0,0\n");
  }
  const auto same = ParseMarkers("m.csv", tracks);
  ASSERT_TRUE(same.ok()) << same.status();
  EXPECT_LT((same->motion - pairs->motion).norm(), 1e-9);
  EXPECT_LT((same->rest - pairs->rest).norm(), 1e-9);
  const auto ras = ParseMarkers("m.csv", "# space=ras\n# place=centred\n" + (kMarkerHeader + rows));
  ASSERT_TRUE(ras.ok());
  EXPECT_TRUE(ras->centred);
  EXPECT_NEAR(ras->motion(1, 0), 0.006, 1e-12);
}

TEST(MarkerFiles, AreRefusedWithTheLineAndTheRemedy) {
  std::string wide;
  for (int i = 0; i < 100'000; ++i) absl::StrAppend(&wide, "a_x,");
  EXPECT_THAT(MarkerFault(wide + "a_x\n1\n"), HasSubstr("m.csv:1: the header has 100001 columns, more than 8000"));
  EXPECT_THAT(MarkerFault("a,b\n1,2\n"), HasSubstr("m.csv:1: the first line must name the columns name,rest_x"));
  EXPECT_THAT(MarkerFault("rest_x,rest_y,rest_z\n1,2,3\n"), HasSubstr("moved_x, moved_y, moved_z are missing"));
  EXPECT_THAT(MarkerFault(absl::StrCat(kMarkerHeader, "a,1,2,3,4,5\n")),
              HasSubstr("m.csv:2: column 7, \"moved_z\", is missing"));
  EXPECT_THAT(MarkerFault(absl::StrCat(kMarkerHeader, "a,1,2,3,4,5,6\n")), HasSubstr("3 markers at least"));
  const auto chest = [](double scale, double moved) {
    return absl::StrFormat("%sa,0,%g,0,0,%g,0\nb,%g,0,0,%g,0,0\nc,%g,0,0,%g,0,0\n", kMarkerHeader, -100 * scale,
                           -106 * scale * moved, 100 * scale, 104 * scale, -100 * scale, -104 * scale);
  };
  EXPECT_TRUE(ParseMarkers("m.csv", chest(1, 1)).ok());
  EXPECT_THAT(MarkerFault(chest(0.001, 1)), HasSubstr("multiply metres by 1000"));
  EXPECT_THAT(MarkerFault(chest(10, 1)), HasSubstr("coordinates must be in mm"));
  EXPECT_THAT(MarkerFault(chest(1, 4)), HasSubstr("a marker moves by"));
}

// Motion capture of 30 markers on a person who breathes deeply: ../shared/data/motion.
TEST(MarkerFiles, OfARealChestShowItsBreath) {
  const std::string file = PHRENIC_SHARED_DIR "/data/motion/chest_markers/markers.csv";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is absent: markers on a chest";
  std::ifstream stream(file);
  const auto markers = ParseMarkers(file, std::string(std::istreambuf_iterator<char>(stream), {}));
  ASSERT_TRUE(markers.ok()) << markers.status();
  ASSERT_EQ(markers->rest.cols(), 30);
  const double most = markers->motion.row(2).maxCoeff();
  std::printf("markers rise by up to %.1f mm\n", 1000 * most);
  EXPECT_GT(most, 0.015) << "upper front markers rise by 33 to 37 mm between the extremes";
  EXPECT_LT(most, 0.05);
}

}  // namespace
}  // namespace phrenic::fit
