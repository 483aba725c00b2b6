// The streaming study: errors keep their bounds, and the Pareto front is marked correctly.
#include "server/study/streaming.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "tests/study/run_on.h"

namespace phrenic::study {
namespace {

// A sheet, part of which is driven by an oscillation.
const char kWavingSheet[] = R"(
  name: "swing" title: "Swing"
  bodies {
    name: "sheet" role: ROLE_DEFORMABLE
    grid { columns: 12 rows: 12 u { x: 0.01 } v { y: 0.01 } }
    material { density: 1030 thickness: 0.003 }
  }
  motions { oscillation { body: "sheet" vertices: [132, 133, 142, 143] amplitude { z: 0.01 } period: 1 } }
  forces { springs { bodies: "sheet" stiffness: 50 } }
  forces { friction { bodies: "sheet" rate: 5 } }
)";

v1::CreateStudyRequest Wanted() {
  v1::CreateStudyRequest request;
  request.mutable_streaming()->set_frames(12);
  request.mutable_streaming()->set_interval(0.1);
  return request;
}

TEST(StreamingStudy, ErrorsKeepTheirBounds) {
  const auto result = RunOn(kWavingSheet, Wanted());
  ASSERT_TRUE(result.ok()) << result.status();
  const v1::StreamingTable& table = result->streaming();
  EXPECT_EQ(table.vertices(), 144);
  std::map<std::string, int> rows;
  for (const v1::StreamingRow& row : table.rows()) {
    ++rows[row.codec()];
    EXPECT_LE(row.error_max_mm(), row.bound_mm()) << row.codec();
    EXPECT_LE(row.error_rms_mm(), row.error_max_mm()) << row.codec();
    EXPECT_EQ(row.verdict(), "ok") << row.codec() << " within " << row.bound_mm();
    EXPECT_NEAR(row.mbit_per_second(), 8e-6 * 30 * row.bytes_per_frame(), 1e-9);
  }
  EXPECT_EQ(rows["raw"], 1);
  EXPECT_EQ(rows["predicted"], 10);
  EXPECT_EQ(rows["basis"], 10);
  EXPECT_THAT(table.advice(), testing::HasSubstr("Within 0.1 mm a frame takes"));
}

TEST(StreamingStudy, ACoarserBoundNeedsNoMoreBytesAndNothingBeatsTheParetoFront) {
  const auto result = RunOn(kWavingSheet, Wanted());
  ASSERT_TRUE(result.ok()) << result.status();
  const v1::StreamingRow* before = nullptr;
  for (const v1::StreamingRow& row : result->streaming().rows()) {
    if (before != nullptr && before->codec() == "predicted" && row.codec() == "predicted") {
      EXPECT_LE(row.bytes_per_frame(), before->bytes_per_frame()) << row.bound_mm();
    }
    before = &row;
    if (!row.pareto()) continue;
    for (const v1::StreamingRow& other : result->streaming().rows()) {
      EXPECT_FALSE(other.bytes_per_frame() < row.bytes_per_frame() && other.error_max_mm() <= row.error_max_mm());
    }
  }
}

TEST(StreamingStudy, StopsWhenCancelled) {
  const auto result = RunOn(kWavingSheet, Wanted(), [](double done, std::string_view) { return done < 0.5; });
  EXPECT_TRUE(absl::IsCancelled(result.status())) << result.status();
}

TEST(StreamingStudy, RefusesASceneWithoutMotion) {
  const auto result = RunOn(R"(
    name: "post" title: "Post"
    bodies { name: "post" role: ROLE_AT_REST polyhedron { vertices { x: 1 } vertices { x: 2 } edges { a: 0 b: 1 } } }
  )",
                            Wanted());
  EXPECT_FALSE(result.ok());
}

}  // namespace
}  // namespace phrenic::study
