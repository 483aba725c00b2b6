#include "server/mesh/mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "tests/mesh/solids.h"

namespace phrenic {
namespace {

using testing::HasSubstr;

std::string ErrorText(const Mesh& mesh) { return std::string(Validate(mesh).message()); }

TEST(MeshValidation, AcceptsAValidMesh) { EXPECT_TRUE(Validate(Tetrahedron()).ok()); }

TEST(MeshValidation, RejectsAMeshWithoutVertices) {
  EXPECT_EQ(Validate(Mesh{}).code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(ErrorText(Mesh{}), HasSubstr("no vertices"));
}

TEST(MeshValidation, NamesTheNonFiniteVertex) {
  Mesh mesh = Tetrahedron();
  mesh.vertices(2, 3) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(ErrorText(mesh), HasSubstr("vertex 3"));
  mesh.vertices(2, 3) = std::numeric_limits<double>::infinity();
  EXPECT_THAT(ErrorText(mesh), HasSubstr("vertex 3"));
}

TEST(MeshValidation, NamesTheTriangleAndTheIndexOutOfRange) {
  Mesh mesh = Tetrahedron();
  mesh.triangles(1, 2) = 4;
  EXPECT_THAT(ErrorText(mesh), HasSubstr("triangle 2 names vertex 4"));
  EXPECT_THAT(ErrorText(mesh), HasSubstr("0 to 3"));
  mesh.triangles(1, 2) = -1;
  EXPECT_THAT(ErrorText(mesh), HasSubstr("triangle 2 names vertex -1"));
}

TEST(MeshValidation, NamesTheEdgeAndTheIndexOutOfRange) {
  Mesh mesh = Tetrahedron();
  mesh.edges.resize(2, 1);
  mesh.edges << 0, 7;
  EXPECT_THAT(ErrorText(mesh), HasSubstr("edge 0 names vertex 7"));
}

TEST(MeshValidation, NamesTheRegionAndTheIndexOutOfRange) {
  Mesh mesh = Tetrahedron();
  mesh.regions["tendon"] = {0, 4};
  EXPECT_THAT(ErrorText(mesh), HasSubstr("region \"tendon\" names vertex 4"));
}

}  // namespace
}  // namespace phrenic
