#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "server/meshio/meshio.h"
#include "tests/meshio/malformed.h"

namespace phrenic::meshio {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr char kPentagon[] =
    "ply\nformat ascii 1.0\n"
    "element vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n2 1 0\n1 2 0\n0 1 0\n5 0 1 2 3 4\n";

TEST(Ply, PolygonsBecomeFansAtTheirFirstVertex) {
  const auto mesh = Parse("a.ply", kPentagon, 1.0);
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  ASSERT_EQ(mesh->triangles.cols(), 3);
  EXPECT_EQ(mesh->triangles.col(0), Eigen::Vector3i(0, 1, 2));
  EXPECT_EQ(mesh->triangles.col(2), Eigen::Vector3i(0, 3, 4));
}

TEST(Ply, ErrorsNameTheLineAndTheProblem) {
  ExpectParseErrors(
      "a.ply", kPentagon,
      {
          {"ply\n", "plx\n", "a.ply:1: ", "start with \"ply\""},
          {"format ascii 1.0\n", "", "a.ply:2: ", "second line"},
          {"ascii", "zip", "a.ply:2: ", "encoding \"zip\""},
          {"1.0", "2.0", "a.ply:2: ", "version"},
          {"element vertex 5", "element vertex", "a.ply:3: ", "element name count"},
          {"element vertex 5", "element vertex -5", "a.ply:3: ", "element name count"},
          {"element vertex 5", "element vertex 99999999999", "a.ply:3: ", "element name count"},
          {"element vertex 5\n", "", "a.ply:3: ", "precedes the first element"},
          {"float x", "quad x", "a.ply:4: ", "no PLY type \"quad\""},
          {"float x", "float u", "a.ply:9: ", "no property \"x\""},
          {"list uchar", "list float", "a.ply:8: ", "integer type"},
          {"end_header\n", "end\n", "a.ply:9: ", "no PLY statement \"end\""},
          {"element face 1", "element face 1\nelement empty 7", "a.ply:10: ", "has no properties"},
          {"element face 1", "element vertex 1\nproperty float x", "a.ply:10: ", "two elements \"vertex\""},
          {"2 1 0\n", "2 inf 0\n", "a.ply:12: ", "vertex's y is not a finite number"},
          {"2 1 0\n", "2 1\n", "a.ply:12: ", "ends early"},
          {"2 1 0\n", "2 1 0 7\n", "a.ply:12: ", "more numbers"},
          {"5 0 1 2 3 4", "5 0 1 2 3 5", "a.ply:15: ", "index 5 names no vertex; there are 5"},
          {"5 0 1 2 3 4", "5 0 1 2 3 -1", "a.ply:15: ", "index -1 names no vertex"},
          {"5 0 1 2 3 4", "5 0 1 2 3 1.5", "a.ply:15: ", "index 1.5 names no vertex"},
          {"5 0 1 2 3 4", "2 0 1", "a.ply:15: ", "at least 3"},
          {"5 0 1 2 3 4", "-1 0 1", "a.ply:15: ", "length is not a whole number"},
          {"5 0 1 2 3 4\n", "", "a.ply:14: ", "the file ends after 0 of 1 rows of element \"face\""},
          {"5 0 1 2 3 4\n", "5 0 1 2 3 4\n3 0 1 2\n", "a.ply:16: ", "data after the last row"},
          {"vertex_indices", "corners", "a.ply:15: ", "no list \"vertex_indices\""},
          {"element face 1", "element tristrips 1", "a.ply:15: ", "triangle strips are not read"},
      });
}

TEST(Ply, ErrorsInBinaryNameTheByte) {
  Mesh mesh;
  mesh.vertices = Points::Identity(3, 3);
  mesh.triangles.resize(3, 1);
  mesh.triangles << 0, 1, 2;
  const std::string valid = *Write("a.ply", mesh, 1.0);
  const auto truncated = Parse("a.ply", std::string_view(valid).substr(0, valid.size() - 1), 1.0);
  EXPECT_THAT(std::string(truncated.status().message()), HasSubstr("ends early"));
  EXPECT_THAT(std::string(truncated.status().message()),
              StartsWith("a.ply:byte " + std::to_string(valid.size() - 4) + ":"));
}

}  // namespace
}  // namespace phrenic::meshio
