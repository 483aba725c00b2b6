#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/fit/read_landmarks.h"

namespace phrenic::fit {
namespace {

using testing::HasSubstr;

constexpr char kHeader[] = "exhale_x,exhale_y,exhale_z,inhale_x,inhale_y,inhale_z\n";

std::string FaultOf(const std::string& name, const std::string& text) {
  const auto landmarks = ParseLandmarks(name, text);
  EXPECT_FALSE(landmarks.ok());
  return std::string(landmarks.status().message());
}

TEST(Landmarks, OfACsvArePairsInMetresAndLps) {
  const auto pairs = ParseLandmarks("a.csv", std::string("# any comment\n") + kHeader + "10,20,-30,11,22,-33\r\n\n");
  ASSERT_TRUE(pairs.ok()) << pairs.status();
  ASSERT_EQ(pairs->size(), 1);
  EXPECT_TRUE(pairs->exhale.col(0).isApprox(Eigen::Vector3d(0.01, 0.02, -0.03), 1e-12));
  EXPECT_TRUE(pairs->motion.col(0).isApprox(Eigen::Vector3d(0.001, 0.002, -0.003), 1e-9));
}

TEST(Landmarks, InRasAreTurnedWithTheirMotion) {
  const auto pairs = ParseLandmarks("a.csv", std::string("# space=ras\n") + kHeader + "10,20,30,11,22,33\n");
  ASSERT_TRUE(pairs.ok()) << pairs.status();
  EXPECT_TRUE(pairs->exhale.col(0).isApprox(Eigen::Vector3d(-0.01, -0.02, 0.03), 1e-12));
  EXPECT_TRUE(pairs->motion.col(0).isApprox(Eigen::Vector3d(-0.001, -0.002, 0.003), 1e-9));
}

TEST(Landmarks, HaveColumnsInAnyOrderAndOthersBesideThem) {
  const auto points = ParseLandmarks("a.csv", "name, Z ,y,x\nfirst,3,2,1\n");
  ASSERT_TRUE(points.ok()) << points.status();
  EXPECT_TRUE(points->exhale.col(0).isApprox(Eigen::Vector3d(0.001, 0.002, 0.003), 1e-12));
  EXPECT_FALSE(points->paired());
}

TEST(Landmarks, AreRefusedWithTheLineAndTheRemedy) {
  EXPECT_THAT(FaultOf("a.csv", ""), HasSubstr("a.csv: no landmarks"));
  EXPECT_THAT(FaultOf("a.csv", kHeader), HasSubstr("no landmarks"));
  EXPECT_THAT(FaultOf("a.csv", "1,2,3,4,5,6\n"), HasSubstr("a.csv:1: the first line must name the columns exhale_x"));
  EXPECT_THAT(FaultOf("a.csv", "x,y,z,inhale_x\n1,2,3,4\n"), HasSubstr("a.csv:1: the first line"));
  EXPECT_THAT(FaultOf("a.csv", "x,y,z,x\n1,2,3,4\n"), HasSubstr("names a column twice"));
  EXPECT_THAT(FaultOf("a.csv", std::string(kHeader) + "1,2,3,4,5\n"), HasSubstr("a.csv:2: the header has a column 6"));
  EXPECT_THAT(FaultOf("a.csv", std::string(kHeader) + "1,2,3,4,5,nan\n"),
              HasSubstr("a.csv:2: \"nan\" in column 6 is not a finite number"));
  EXPECT_THAT(FaultOf("a.csv", std::string(kHeader) + "1,2,3,4,5,1e300\n"), HasSubstr("finite numbers up to 100 m"));
  EXPECT_THAT(FaultOf("a.csv", "# space=left\nx,y,z\n1,2,3\n"), HasSubstr("a.csv:1: the space must be lps or ras"));
}

TEST(Landmarks, OfSlicersMarkupsAreReadInBothFormats) {
  const auto list = ParseLandmarks("a.fcsv",
                                   "# Markups fiducial file version = 4.11\n# CoordinateSystem = LPS\n"
                                   "# columns = id,x,y,z,ow,ox,oy,oz,vis,sel,lock,label,desc\n"
                                   "1,10,20,30,0,0,0,1,1,1,0,F-1,\n");
  ASSERT_TRUE(list.ok()) << list.status();
  EXPECT_TRUE(list->exhale.col(0).isApprox(Eigen::Vector3d(0.01, 0.02, 0.03), 1e-12));
  EXPECT_EQ(list->labels.front(), "F-1");
  const auto json = ParseLandmarks("a.mrk.json", R"({"markups": [{"coordinateSystem": "RAS", "coordinateUnits": "mm",
      "controlPoints": [{"label": "F-1", "position": [-11, -22, 33]}]}]})");
  ASSERT_TRUE(json.ok()) << json.status();
  const auto pairs = PairLandmarks(*list, *json);
  ASSERT_TRUE(pairs.ok()) << pairs.status();
  EXPECT_TRUE(pairs->motion.col(0).isApprox(Eigen::Vector3d(0.001, 0.002, 0.003), 1e-9));
}

TEST(Landmarks, OfAnOlderSlicerAreRasUnlessTheFileSaysElse) {
  const auto old = ParseLandmarks("a.fcsv", "# CoordinateSystem = 0\n1,10,20,30\n");
  ASSERT_TRUE(old.ok()) << old.status();
  EXPECT_LT(old->exhale(0, 0), 0);
  EXPECT_GT(ParseLandmarks("a.fcsv", "# CoordinateSystem = 1\n1,10,20,30\n")->exhale(0, 0), 0);
}

TEST(Landmarks, OfSlicerAreRefusedWithThePoint) {
  EXPECT_THAT(FaultOf("a.fcsv", "# CoordinateSystem = IJK\n1,2,3,4\n"), HasSubstr("a.fcsv:1: the coordinate system"));
  EXPECT_THAT(FaultOf("a.fcsv", "1,2,3\n"), HasSubstr("a.fcsv:1: a point is a line id,x,y,z"));
  EXPECT_THAT(FaultOf("a.mrk.json", "{"), HasSubstr("a.mrk.json: no \"markups\""));
  EXPECT_THAT(FaultOf("a.mrk.json", R"({"markups": [7]})"), HasSubstr("coordinateSystem must be LPS or RAS"));
  EXPECT_THAT(FaultOf("a.mrk.json", R"({"markups": [{"coordinateSystem": "LPS", "controlPoints": [{}]}]})"),
              HasSubstr("point 1: its position must be three numbers"));
  EXPECT_THAT(FaultOf("a.mrk.json", R"({"markups": [{"coordinateSystem": "LPS", "coordinateUnits": "m"}]})"),
              HasSubstr("coordinateUnits must be mm"));
}

TEST(Landmarks, ArePairedOnlyInOneOrder) {
  const Landmarks two = {Points::Zero(3, 2), Points(3, 0), {"a", "b"}},
                  swapped = {Points::Zero(3, 2), Points(3, 0), {"b", "a"}};
  const Landmarks one = {Points::Zero(3, 1), Points(3, 0), {"a"}};
  EXPECT_TRUE(PairLandmarks(two, two).ok());
  EXPECT_THAT(std::string(PairLandmarks(two, swapped).status().message()), HasSubstr("point 1 is \"a\" at end exhale"));
  EXPECT_THAT(std::string(PairLandmarks(two, one).status().message()), HasSubstr("has 2 points, that of end inhale 1"));
  EXPECT_THAT(std::string(ReadLandmarks({"/no/such.csv"}).status().message()), HasSubstr("check the path"));
  EXPECT_THAT(std::string(ReadLandmarks({"/dev/zero"}).status().message()), HasSubstr("at most 64 MiB"));
}

}  // namespace
}  // namespace phrenic::fit
