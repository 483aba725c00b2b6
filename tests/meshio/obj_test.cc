#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <string>

#include "server/meshio/meshio.h"
#include "tests/meshio/malformed.h"

namespace phrenic::meshio {
namespace {

using ::testing::HasSubstr;

constexpr char kTetrahedron[] =
    "# a tetrahedron\n"
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
    "vt 0.5 0.5\nvn 0 0 1\n"
    "f 1 3 2\nf 1/1 2/1 4/1\nf 1//1 4//1 3//1\nf 2/1/1 3/1/1 4/1/1\n";

TEST(Obj, AllFaceSyntaxesGiveTheSameVertices) {
  const auto mesh = Parse("a.obj", kTetrahedron, 1.0);
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  ASSERT_EQ(mesh->vertices.cols(), 4);
  ASSERT_EQ(mesh->triangles.cols(), 4);
  EXPECT_EQ(mesh->triangles.col(0), Eigen::Vector3i(0, 2, 1));
  EXPECT_EQ(mesh->triangles.col(1), Eigen::Vector3i(0, 1, 3));
  EXPECT_EQ(mesh->triangles.col(2), Eigen::Vector3i(0, 3, 2));
  EXPECT_EQ(mesh->triangles.col(3), Eigen::Vector3i(1, 2, 3));
  EXPECT_EQ(mesh->edges.cols(), 0);
}

TEST(Obj, UnitScalesCoordinates) {
  const auto mesh = Parse("A.OBJ", "v 1 -2e1 +3.5\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", 0.001);
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_TRUE(mesh->vertices.col(0).isApprox(Eigen::Vector3d(0.001, -0.02, 0.0035), 1e-15));
}

TEST(Obj, NegativeIndicesCountFromTheLatestVertex) {
  const auto mesh = Parse("a.obj", "v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 5 5 5\nf -4 -3 -1\n", 1.0);
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_EQ(mesh->triangles.col(0), Eigen::Vector3i(1, 2, 3));
  EXPECT_EQ(mesh->triangles.col(1), Eigen::Vector3i(1, 2, 4));
}

TEST(Obj, PolygonsBecomeFansAtTheirFirstVertex) {
  const auto mesh = Parse("a.obj", "v 0 0 0\nv 1 0 0\nv 2 1 0\nv 1 2 0\nv 0 1 0\nf 1 2 3 4 5 # a pentagon\n", 1.0);
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  ASSERT_EQ(mesh->triangles.cols(), 3);
  EXPECT_EQ(mesh->triangles.col(0), Eigen::Vector3i(0, 1, 2));
  EXPECT_EQ(mesh->triangles.col(1), Eigen::Vector3i(0, 2, 3));
  EXPECT_EQ(mesh->triangles.col(2), Eigen::Vector3i(0, 3, 4));
}

TEST(Obj, LineEndingsContinuationsAndOrderDoNotMatter) {
  const auto expected = Parse("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", 1.0);
  ASSERT_TRUE(expected.ok());
  for (const char* text : {"v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n", "f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0",
                           "# C:\\scans\\\nv 0 0 0\nv 1 0 0\n\n   v\t0 1 \\\r\n0\nf 1 2 \\\n 3",
                           "v 0 0 0 1 0 0\nv 1 0 0 1\nv 0 1 0\nf 1 2 3"}) {
    const auto mesh = Parse("a.obj", text, 1.0);
    ASSERT_TRUE(mesh.ok()) << text << mesh.status();
    EXPECT_EQ(mesh->vertices, expected->vertices) << text;
    EXPECT_EQ(mesh->triangles, expected->triangles) << text;
  }
}

TEST(Obj, LinesBecomeANetworkOnlyWithoutTriangles) {
  const auto network = Parse("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nl 1 2 3\n", 1.0);
  ASSERT_TRUE(network.ok()) << network.status();
  ASSERT_EQ(network->edges.cols(), 2);
  EXPECT_EQ(network->edges.col(1), Eigen::Vector2i(1, 2));
  const auto surface = Parse("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nl 1 2\nf 1 2 3\n", 1.0);
  ASSERT_TRUE(surface.ok());
  EXPECT_EQ(surface->edges.cols(), 0);
}

TEST(Obj, ErrorsNameTheLineAndTheProblem) {
  struct {
    const char *text, *start, *words;
  } constexpr kFiles[] = {
      {"", "a.obj:0: ", "no vertices"},
      {"v 0 0 0\nv 1 0\n", "a.obj:2: ", "vertex's z"},
      {"v 0 nan 0\n", "a.obj:1: ", "vertex's y"},
      {"v 0 0 inf\n", "a.obj:1: ", "vertex's z"},
      {"v 0 0 1e999\n", "a.obj:1: ", "not a finite number"},
      {"v 0 0 0\nv 1 0 0\nv 0 1 0\n", "a.obj:3: ", "3 vertices but no faces"},
      {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\n", "a.obj:4: ", "at least 3"},
      {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\nf 1 2 3\n", "a.obj:4: ", "index 4 is past the last vertex; the file has 3"},
      {"v 0 0 0\nf 1 2 99999999999\n", "a.obj:2: ", "names no vertex"},
      {"v 0 0 0\nf 1 1 2147483647\n", "a.obj:2: ", "index 2147483647 is past"},
      {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", "a.obj:4: ", "indices start at 1"},
      {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf -1 -2 -4\n", "a.obj:4: ", "is before the first vertex"},
      {"v 0 0 0\nf a b c\n", "a.obj:2: ", "\"a\" names no vertex"},
      {"v 0 0 0\nvv 1 0 0\n", "a.obj:2: ", "no OBJ statement \"vv\""},
      {"\x7f"
       "ELF\x02\x01\n",
       "a.obj:1: ", "is this an OBJ file"},
  };
  for (const auto& file : kFiles) ExpectParseError("a.obj", file.text, file.start, file.words);
}

TEST(Obj, ScalingToInfinityIsAnError) {
  const auto mesh = Parse("a.obj", "v 0 0 1e308\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", 1e3);
  EXPECT_EQ(mesh.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(mesh.status().message()), HasSubstr("finite"));
}

TEST(Obj, EveryTruncationGivesAValidMeshOrAnError) { ExpectTruncationsHandled("a.obj", kTetrahedron); }

TEST(Obj, EveryGarbledByteGivesAValidMeshOrAnError) {
  ExpectGarbledBytesHandled("a.obj", kTetrahedron, std::string_view("\0\n-9/\\\xff", 7));
}

TEST(Files, ErrorsNameMissingFilesAndUnknownExtensions) {
  EXPECT_EQ(ReadFile("/nowhere/lung.obj", 1.0).status().code(), absl::StatusCode::kNotFound);
  EXPECT_THAT(std::string(ReadFile("/nowhere/lung.obj", 1.0).status().message()), HasSubstr("/nowhere/lung.obj"));
  EXPECT_EQ(ReadFile(PHRENIC_SOURCE_DIR, 1.0).status().code(), absl::StatusCode::kInvalidArgument);
  const auto unknown = Parse("lung.stp", "solid", 1.0);
  EXPECT_THAT(std::string(unknown.status().message()), HasSubstr(Endings()));
}

// The meshes of the patient scene; the expected counts come from their authors.
class RealMeshes : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(data_)) GTEST_SKIP() << "the example meshes are missing: " << data_;
  }
  const std::filesystem::path data_ = std::filesystem::path(PHRENIC_SHARED_DIR) / "data" / "thorax";
};

TEST_F(RealMeshes, AllCanBeRead) {
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(data_)) {
    if (entry.path().extension() != ".obj") continue;
    const auto mesh = ReadFile(entry.path().string(), 0.001);
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_GT(mesh->triangles.cols(), 0) << entry.path();
    EXPECT_LT(mesh->vertices.cwiseAbs().maxCoeff(), 2.0) << entry.path() << " is not in metres";
    ++files;
  }
  EXPECT_GT(files, 50);
}

TEST_F(RealMeshes, TheDiaphragmIsCompleteAndReadsFast) {
  const auto start = std::chrono::steady_clock::now();
  const auto mesh = ReadFile((data_ / "diaphragm.obj").string(), 0.001);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_EQ(mesh->vertices.cols(), 19432);
  EXPECT_EQ(mesh->triangles.cols(), 38868);
  RecordProperty("milliseconds", std::to_string(took.count() * 1e3));
  // Measured: 5 ms. The bound allows for sanitizers and a busy machine.
  EXPECT_LT(took.count(), 1.0);
}

}  // namespace
}  // namespace phrenic::meshio
