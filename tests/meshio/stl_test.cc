#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "server/meshio/meshio.h"
#include "tests/meshio/malformed.h"

namespace phrenic::meshio {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string Facet(const std::string& a, const std::string& b, const std::string& c) {
  return absl::StrCat("facet normal nan 0 1\nouter loop\nvertex ", a, "\nvertex ", b, "\nvertex ", c,
                      "\nendloop\nendfacet\n");
}

const char* const kSolid = "solid two words\n";

TEST(Stl, OnlyEqualPointsAreMerged) {
  const auto mesh = Parse("a.stl",
                          kSolid + Facet("0 0 0", "1 0 0", "0 1 0") + Facet("-0 0.0 0e0", "0 1 0", "1.0000000001 0 0") +
                              "endsolid two words\n",
                          1.0);
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_EQ(mesh->vertices.cols(), 4);
  EXPECT_EQ(mesh->triangles.col(1), Eigen::Vector3i(0, 2, 3));
}

TEST(Stl, CaseLineEndingsAndTheNumberOfSolidsDoNotMatter) {
  const std::string one = kSolid + Facet("0 0 0", "1 0 0", "0 1 0") + "endsolid\n";
  for (const std::string& text :
       {absl::StrReplaceAll(one, {{"\n", "\r\n"}}),
        absl::StrReplaceAll(one, {{"facet", "FACET"}, {"vertex", "Vertex"}}), "\n  " + one + "solid\nendsolid"}) {
    const auto mesh = Parse("a.stl", text, 1.0);
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_EQ(mesh->triangles.cols(), 1);
  }
}

TEST(Stl, ErrorsInTextNameTheLineAndTheProblem) {
  ExpectParseErrors(
      "a.stl", kSolid + Facet("0 0 0", "1 0 0", "0 1 0") + "endsolid\n",
      {
          {"vertex 1 0 0", "vertex 1 0", "a.stl:5: ", "vertex x y z"},
          {"vertex 1 0 0", "vertex 1 0 nan", "a.stl:5: ", "finite"},
          {"vertex 1 0 0", "vertex 1 0 0 0", "a.stl:5: ", "vertex x y z"},
          {"vertex 1 0 0\n", "", "a.stl:6: ", "\"vertex\" is expected, not \"endloop\""},
          {"outer loop\n", "", "a.stl:3: ", "\"outer\" is expected"},
          {"endfacet\n", "endfacet\nfaces\n", "a.stl:9: ", "\"facet\" or \"endsolid\" is expected, not \"faces\""},
          {"endsolid", "", "a.stl:9: ", "truncated"},
          {"endsolid", "endsolid\nfacet", "a.stl:10: ", "\"solid\" is expected"},
      });
  EXPECT_THAT(std::string(Parse("a.stl", "solid\nendsolid\n", 1.0).status().message()), HasSubstr("no triangles"));
}

TEST(Stl, ErrorsInBinaryNameTheByteAndTheProblem) {
  Mesh mesh;
  mesh.vertices = Points::Identity(3, 3);
  mesh.triangles.resize(3, 1);
  mesh.triangles << 0, 1, 2;
  const std::string valid = *Write("a.stl", mesh, 1.0);
  const std::string nan("\0\0\xc0\x7f", 4);
  const std::pair<std::string, const char*> files[] = {
      {valid.substr(0, 100), "a.stl:byte 80: the file declares 1 triangles, which take 134 bytes, but has 100"},
      {valid + "\n", "a.stl:byte 80: the file declares 1 triangles, which take 134 bytes, but has 135"},
      {valid.substr(0, 70), "a.stl:byte 70: the file is neither text STL"},
      {std::string(84, '\0'), "a.stl:byte 80: the file declares 0 triangles"},
      {std::string(valid).replace(84 + 12 + 16, 4, nan), "a.stl:byte 108: triangle 0 has a corner that is not finite"},
  };
  for (const auto& [bytes, words] : files) {
    const auto read = Parse("a.stl", bytes, 1.0);
    EXPECT_EQ(read.status().code(), absl::StatusCode::kInvalidArgument) << words;
    EXPECT_THAT(std::string(read.status().message()), StartsWith(words));
  }
}

}  // namespace
}  // namespace phrenic::meshio
