#include "server/compare/comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "server/record/msh.h"
#include "tests/compare/surfaces.h"

namespace phrenic::compare {
namespace {

using ::testing::AllOf;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::FloatNear;
using ::testing::HasSubstr;
using ::testing::IsNan;
using ::testing::SizeIs;

constexpr char kObj[] = "v 0 0 0\nv 100 0 0\nv 0 100 0\nf 1 2 3\n";

// An MSH file as `phrenic run --export` writes it: a square that rises by `speed` [m/s], beside a fixed square.
std::string MotionText(double speed, const std::vector<double>& times, const std::string& second = "still") {
  std::string text;
  const auto recorder = record::MakeMshRecorder({.sink =
                                                     [&text](std::string_view bytes) {
                                                       text += bytes;
                                                       return absl::OkStatus();
                                                     },
                                                 .values = record::Values::kDisplacements});
  const Mesh rising = Square(0.1, 2), still = Moved(Square(0.1, 2), {1, 0, 0});
  EXPECT_TRUE(recorder->Begin({.bodies = {{"rising", rising}, {second, still}}}).ok());
  for (const double time : times) {
    Points x(3, rising.vertices.cols() + still.vertices.cols());
    x << rising.vertices, still.vertices;
    x.row(2).head(rising.vertices.cols()).array() += speed * (time - times.front());
    EXPECT_TRUE(recorder->AddFrame({time, x, {}}).ok());
  }
  EXPECT_TRUE(recorder->End([](double) { return absl::OkStatus(); }).ok());
  return text;
}

v1::CompareRequest Request(const std::string& name_a, const std::string& a, const std::string& name_b,
                           const std::string& b) {
  v1::CompareRequest request;
  request.mutable_a()->set_name(name_a);
  request.mutable_a()->set_content(a);
  request.mutable_b()->set_name(name_b);
  request.mutable_b()->set_content(b);
  return request;
}

// A body source with one session, "s", whose body "square" lies at z = 0 at 0.5 s.
absl::StatusOr<Mesh> BodyOf(const v1::SessionBody& body, v1::ComparedState& state) {
  if (body.session_id() != "s") return absl::NotFoundError("there is no session");
  state.set_session_id("s");
  state.set_body("square");
  state.set_tick(500);
  state.set_time(0.5);
  return Square(0.1, 2);
}

// The output of a comparison beside its table.
struct Output {
  std::string map;
  std::vector<v1::VertexDistances> vertices;
  std::vector<Mesh> meshes;
};

absl::StatusOr<v1::ComparisonTable> Compared(const v1::CompareRequest& request, Output* output = nullptr) {
  return Compare(request, BodyOf,
                 {.progress = [](double) { return true; },
                  .vertices =
                      [output](const v1::VertexDistances& vertices) {
                        if (output != nullptr) output->vertices.push_back(vertices);
                        return absl::OkStatus();
                      },
                  .map =
                      [output](std::string_view bytes) {
                        if (output != nullptr) output->map += bytes;
                        return absl::OkStatus();
                      },
                  .mesh =
                      [output](ConstPoints x, const Triangles& triangles) {
                        Mesh mesh;
                        mesh.vertices = x;
                        mesh.triangles = triangles;
                        if (output != nullptr) output->meshes.push_back(std::move(mesh));
                        return absl::OkStatus();
                      }});
}

// Compares the session's body with a file.
v1::CompareRequest BodyRequest(const std::string& name, const std::string& content) {
  v1::CompareRequest request = Request("", "", name, content);
  request.mutable_a()->mutable_body()->set_session_id("s");
  request.set_vertex_distances(true);
  return request;
}

TEST(Comparison, OfSurfacesHasOneRowWithoutATime) {
  auto request = Request("a.obj", kObj, "b.obj", kObj);
  request.mutable_b()->set_unit_mm(1.1);
  const auto table = Compared(request);
  ASSERT_TRUE(table.ok()) << table.status();
  ASSERT_EQ(table->rows_size(), 1);
  EXPECT_FALSE(table->rows(0).has_time());
  EXPECT_FALSE(table->rows(0).has_baseline());
  EXPECT_NEAR(table->rows(0).distance().area_b() / table->rows(0).distance().area_a(), 1.21, 1e-9);
  EXPECT_FALSE(table->definition().empty());
  EXPECT_EQ(table->tolerance_mm(), 1);
}

// A rises by 10 mm/s and B by 8 mm/s: the distance is 2 mm/s t; against A at rest it is 8 mm/s t.
TEST(Comparison, OfMotionsHasARowATimeWithTheBaselineBesideIt) {
  auto request =
      Request("a.msh", MotionText(0.010, {0, 0.25, 0.5, 0.75, 1, 1.25}), "b.msh", MotionText(0.008, {0, 0.4, 1}));
  request.set_by_region(true);
  const auto table = Compared(request);
  ASSERT_TRUE(table.ok()) << table.status();
  EXPECT_EQ(table->times_left_out(), 1) << "B ends before 1.25 s";
  ASSERT_EQ(table->rows_size(), 3 + 5 * 3) << "whole, rising and still: over all times, and at five";
  for (const v1::ComparisonRow& row : table->rows()) {
    if (!row.has_time()) continue;
    const double moving = row.region() == "still" ? 0 : row.region().empty() ? 0.5 : 1;  // fraction of the area
    EXPECT_NEAR(row.distance().assd(), moving * 2 * row.time(), 1e-4) << row.region() << row.time();
    EXPECT_NEAR(row.baseline().assd(), moving * 8 * row.time(), 1e-4) << row.region() << row.time();
  }
  const v1::ComparisonRow& rising = table->rows(1);
  ASSERT_EQ(rising.region(), "rising");
  EXPECT_NEAR(rising.distance().assd(), 1, 1e-4) << "the mean over 0 to 1 s";
  EXPECT_NEAR(rising.distance().hd_max(), 2, 1e-3) << "the maximum over the times";
  EXPECT_NEAR(rising.distance().rms_a_to_b(), 2 * std::sqrt(0.375), 1e-4) << "the root of the mean of (2 t)^2";
  EXPECT_NEAR(rising.baseline().hd_max(), 8, 2e-3);
}

TEST(Comparison, PhasesAreMatchedWhereTimesAreNot) {
  auto request = Request("a.msh", MotionText(0.01, {0, 0.5, 1}), "b.msh", MotionText(0.005, {10, 11, 12}));
  const auto apart = Compared(request);
  ASSERT_FALSE(apart.ok());
  EXPECT_EQ(apart.status().code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_THAT(std::string(apart.status().message()), HasSubstr("A has 0 to 1 s, B 10 to 12 s"));
  request.set_match_phases(true);
  const auto table = Compared(request);
  ASSERT_TRUE(table.ok()) << table.status();
  EXPECT_LT(table->rows(0).distance().hd_max(), 1e-3) << "the same motion over another time";
  EXPECT_EQ(table->times_left_out(), 0);
}

TEST(Comparison, OfAMotionWithASurfaceHasARowATime) {
  const std::string still = MotionText(0, {0}), motion = MotionText(0.01, {0, 1});
  for (const bool swapped : {false, true}) {
    const auto table =
        Compared(swapped ? Request("a.msh", motion, "b.msh", still) : Request("a.msh", still, "b.msh", motion));
    ASSERT_TRUE(table.ok()) << table.status();
    ASSERT_EQ(table->rows_size(), 3);
    EXPECT_EQ(table->rows(2).time(), 1);
    EXPECT_NEAR(table->rows(2).distance().hd_max(), 10, 0.002);
    EXPECT_EQ(table->rows(0).has_baseline(), swapped) << "if A does not move, the comparison equals its baseline";
  }
}

TEST(Comparison, ARegionOfOneFileAloneIsNotANumber) {
  auto request = Request("a.msh", MotionText(0, {0}, "left"), "b.msh", MotionText(0, {0}, "right"));
  request.set_by_region(true);
  const auto table = Compared(request);
  ASSERT_TRUE(table.ok()) << table.status();
  std::vector<std::string> regions;
  for (const auto& row : table->rows()) {
    regions.push_back(row.region());
    const bool common = row.region().empty() || row.region() == "rising";
    EXPECT_EQ(std::isnan(row.distance().hd_max()), !common) << row.region();
  }
  EXPECT_THAT(regions, ElementsAre("", "left", "right", "rising"));
}

TEST(Comparison, SendsTheMeshOfBAsMeasured) {
  Output output;
  auto request = BodyRequest("b.msh", MotionText(0.01, {0, 1}));
  ASSERT_TRUE(Compared(request, &output).ok());
  EXPECT_TRUE(output.meshes.empty()) << "not asked for";
  request.set_mesh_of_b(true);
  ASSERT_TRUE(Compared(request, &output).ok());
  ASSERT_EQ(output.meshes.size(), 1U);
  EXPECT_NEAR(output.meshes[0].vertices(2, 0), 0.005, 1e-6) << "at the session's 0.5 s";
  EXPECT_EQ(output.meshes[0].triangles.cols(), 2 * Square(0.1, 2).triangles.cols());
}

TEST(Comparison, BadInputIsRefusedByName) {
  const auto message = [](const v1::CompareRequest& request) {
    const auto table = Compared(request);
    EXPECT_FALSE(table.ok());
    return std::string(table.status().message());
  };
  EXPECT_THAT(message(Request("a.stp", "", "b.obj", kObj)), HasSubstr("a.stp:1: the file name extension"));
  EXPECT_THAT(message(Request("a.obj", kObj, "b.obj", "v 1 2\n")), HasSubstr("b.obj:1:"));
  auto huge = Request("a.obj", kObj, "b.obj", "v 1e300 0 0\nv 0 1 0\nv 1 0 0\nf 1 2 3\n");
  EXPECT_THAT(message(huge), HasSubstr("has a coordinate of"));
  auto format = Request("a.obj", kObj, "b.obj", kObj);
  format.set_map_format("png");
  EXPECT_THAT(message(format), HasSubstr("map_format: there is no format \"png\"; there are msh, vtp"));
  auto wire = Request("a.obj", kObj, "wire.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n");
  wire.set_map_format("vtp");
  EXPECT_THAT(message(wire), HasSubstr("wire.obj:1: has no triangles"));
}

TEST(Comparison, EndsIfTheCallerCancels) {
  const auto ends = [](bool progress, const absl::Status& vertices) {
    auto request = Request("a.obj", kObj, "b.obj", kObj);
    request.set_vertex_distances(true);
    request.set_mesh_of_b(true);
    const auto table = Compare(request, BodyOf,
                               {.progress = [=](double) { return progress; },
                                .vertices = [=](const v1::VertexDistances&) { return vertices; },
                                .map = [](std::string_view) { return absl::OkStatus(); },
                                .mesh = [=](ConstPoints, const Triangles&) { return vertices; }});
    return table.status().code();
  };
  EXPECT_EQ(ends(true, absl::OkStatus()), absl::StatusCode::kOk);
  EXPECT_EQ(ends(false, absl::OkStatus()), absl::StatusCode::kCancelled);
  EXPECT_EQ(ends(true, absl::CancelledError()), absl::StatusCode::kCancelled);
}

TEST(Comparison, TheMapHasEachVertexOfTheSurfaceAndItsDistance) {
  auto request = Request("a.obj", "v 9 9 9\nv 0 0 5\nv 100 0 2\nv 0 100 3\nf 2 3 4\n", "b.obj", kObj);
  Output output;
  const std::string& map = output.map;
  request.set_map_format("msh");
  ASSERT_TRUE(Compared(request, &output).ok());
  EXPECT_THAT(map, HasSubstr("$Nodes\n3\n")) << "the first vertex is in no triangle";
  EXPECT_THAT(map, HasSubstr("\"distance [mm]\"\n1\n0\n3\n0\n1\n3\n1 5\n2 2\n3 3\n$EndNodeData\n"));
  EXPECT_TRUE(output.vertices.empty()) << "not asked for";
  output.map.clear();
  request.set_map_format("vtp");
  ASSERT_TRUE(Compared(request, &output).ok());
  EXPECT_THAT(map, AllOf(HasSubstr("NumberOfPoints=\"3\""), HasSubstr("<PointData Scalars=\"distance [mm]\">")));
}

TEST(Comparison, VertexDistancesAreThoseOfEachVertexOfA) {
  auto request = Request("a.obj", "v 9 9 9\nv 0 0 5\nv 100 0 2\nv 0 100 3\nf 2 3 4\n", "b.obj", kObj);
  request.set_vertex_distances(true);
  Output output;
  ASSERT_TRUE(Compared(request, &output).ok());
  ASSERT_EQ(output.vertices.size(), 1U);
  EXPECT_FALSE(output.vertices[0].has_time());
  EXPECT_THAT(output.vertices[0].distances(),
              ElementsAre(IsNan(), FloatNear(5, 1e-5), FloatNear(2, 1e-5), FloatNear(3, 1e-5)))
      << "the first vertex is in no triangle";
  EXPECT_TRUE(output.map.empty());
}

TEST(Comparison, VertexDistancesOfAMotionComeOnceATime) {
  auto request = Request("a.msh", MotionText(0.01, {0, 1}), "b.msh", MotionText(0, {0, 1}));
  request.set_vertex_distances(true);
  Output output;
  ASSERT_TRUE(Compared(request, &output).ok());
  ASSERT_EQ(output.vertices.size(), 2U);
  for (int time = 0; time < 2; ++time) {
    EXPECT_EQ(output.vertices[time].time(), time);
    EXPECT_NEAR(output.vertices[time].distances(0), 10 * time, 1e-4);
  }
}

TEST(Comparison, OfASessionsBodySaysWhichStateItWas) {
  Output output;
  const auto table = Compared(BodyRequest("b.obj", "v 0 0 7\nv 100 0 7\nv 100 100 7\nv 0 100 7\nf 1 2 3 4\n"), &output);
  ASSERT_TRUE(table.ok()) << table.status();
  EXPECT_EQ(table->a(), "session:s/square");
  EXPECT_EQ(table->state_a().tick(), 500);
  EXPECT_FALSE(table->has_state_b());
  EXPECT_NEAR(table->rows(0).distance().hd_max(), 7, 1e-6);
  ASSERT_EQ(output.vertices.size(), 1U);
  EXPECT_THAT(output.vertices[0].distances(), SizeIs(Square(0.1, 2).vertices.cols()));
  EXPECT_THAT(output.vertices[0].distances(), Each(FloatNear(7, 1e-4)));
}

// The file's square rises by 10 mm/s: it is 5 mm above the body at the session's time of 0.5 s.
TEST(Comparison, BesideASessionsBodyAMotionIsTakenAtItsTimeOrAtANamedOne) {
  auto request = BodyRequest("b.msh", MotionText(0.01, {0, 1}, "still"));
  request.set_by_region(true);
  const auto at_its_time = Compared(request);
  ASSERT_TRUE(at_its_time.ok()) << at_its_time.status();
  EXPECT_NEAR(at_its_time->rows(0).distance().mean_a_to_b(), 5, 1e-4);
  EXPECT_FALSE(at_its_time->rows(0).has_time());
  request.mutable_b()->set_time(0.25);
  EXPECT_NEAR(Compared(request)->rows(0).distance().mean_a_to_b(), 2.5, 1e-4);
  request.mutable_b()->set_time(1.5);
  const auto status = Compared(request).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_THAT(std::string(status.message()), HasSubstr("b.msh: has no state at 1.5 s; its times are 0 to 1 s"));
  auto later = BodyRequest("b.msh", MotionText(0.01, {1, 2}));
  EXPECT_THAT(std::string(Compared(later).status().message()),
              HasSubstr("0.5 s, the session's time; its times are 1 to 2"));
}

TEST(Comparison, ASessionsBodyHasNeitherUnitNorTimeOfAFile) {
  auto unit = BodyRequest("b.obj", kObj);
  unit.mutable_a()->set_unit_mm(10);
  EXPECT_THAT(std::string(Compared(unit).status().message()), HasSubstr("a.unit_mm: applies to files only"));
  auto time = BodyRequest("b.obj", kObj);
  time.mutable_a()->set_time(1);
  EXPECT_THAT(std::string(Compared(time).status().message()), HasSubstr("a.time: applies to files only"));
  auto unknown = BodyRequest("b.obj", kObj);
  unknown.mutable_a()->mutable_body()->set_session_id("t");
  EXPECT_EQ(Compared(unknown).status().code(), absl::StatusCode::kNotFound);
  EXPECT_THAT(std::string(Compared(Request("", kObj, "b.obj", kObj)).status().message()),
              HasSubstr("a.name: must be set"));
}

}  // namespace
}  // namespace phrenic::compare
