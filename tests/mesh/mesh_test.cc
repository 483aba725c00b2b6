#include "server/mesh/mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "tests/mesh/solids.h"

namespace phrenic {
namespace {

using testing::HasSubstr;

std::string Refusal(const Mesh& mesh) { return std::string(Validate(mesh).message()); }

TEST(MeshValidation, TakesASoundMesh) { EXPECT_TRUE(Validate(Tetrahedron()).ok()); }

TEST(MeshValidation, RefusesNoVertices) {
  EXPECT_EQ(Validate(Mesh{}).code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(Refusal(Mesh{}), HasSubstr("no vertices"));
}

TEST(MeshValidation, NamesTheVertexThatIsNotFinite) {
  Mesh mesh = Tetrahedron();
  mesh.vertices(2, 3) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(Refusal(mesh), HasSubstr("vertex 3"));
  mesh.vertices(2, 3) = std::numeric_limits<double>::infinity();
  EXPECT_THAT(Refusal(mesh), HasSubstr("vertex 3"));
}

TEST(MeshValidation, NamesTheTriangleAndTheIndexPastTheEnd) {
  Mesh mesh = Tetrahedron();
  mesh.triangles(1, 2) = 4;
  EXPECT_THAT(Refusal(mesh), HasSubstr("triangle 2 names vertex 4"));
  EXPECT_THAT(Refusal(mesh), HasSubstr("0 to 3"));
  mesh.triangles(1, 2) = -1;
  EXPECT_THAT(Refusal(mesh), HasSubstr("triangle 2 names vertex -1"));
}

TEST(MeshValidation, NamesTheEdgeAndTheIndexPastTheEnd) {
  Mesh mesh = Tetrahedron();
  mesh.edges.resize(2, 1);
  mesh.edges << 0, 7;
  EXPECT_THAT(Refusal(mesh), HasSubstr("edge 0 names vertex 7"));
}

TEST(MeshValidation, NamesTheRegionAndTheIndexPastTheEnd) {
  Mesh mesh = Tetrahedron();
  mesh.regions["tendon"] = {0, 4};
  EXPECT_THAT(Refusal(mesh), HasSubstr("region \"tendon\" names vertex 4"));
}

}  // namespace
}  // namespace phrenic
