#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "server/meshio/meshio.h"

namespace phrenic::meshio {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string Facet(const std::string& a, const std::string& b, const std::string& c) {
  return absl::StrCat("facet normal nan 0 1\nouter loop\nvertex ", a, "\nvertex ", b, "\nvertex ", c,
                      "\nendloop\nendfacet\n");
}

const char* const kSolid = "solid two words\n";

TEST(Stl, OnlyVerticesAtExactlyOnePlaceBecomeOne) {
  const auto mesh = Parse("a.stl",
                          kSolid + Facet("0 0 0", "1 0 0", "0 1 0") + Facet("-0 0.0 0e0", "0 1 0", "1.0000000001 0 0") +
                              "endsolid two words\n",
                          1.0);
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_EQ(mesh->vertices.cols(), 4);
  EXPECT_EQ(mesh->triangles.col(1), Eigen::Vector3i(0, 2, 3));
}

TEST(Stl, LettersLineEndsAndTheNumberOfSolidsDoNotMatter) {
  const std::string one = kSolid + Facet("0 0 0", "1 0 0", "0 1 0") + "endsolid\n";
  for (const std::string& text :
       {absl::StrReplaceAll(one, {{"\n", "\r\n"}}),
        absl::StrReplaceAll(one, {{"facet", "FACET"}, {"vertex", "Vertex"}}), "\n  " + one + "solid\nendsolid"}) {
    const auto mesh = Parse("a.stl", text, 1.0);
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_EQ(mesh->triangles.cols(), 1);
  }
}

struct BadStl {
  const char* from;
  const char* to;
  const char* start;
  const char* words;
};

TEST(Stl, ErrorsInTextNameTheLineAndTheFault) {
  const BadStl changes[] = {
      {"vertex 1 0 0", "vertex 1 0", "a.stl:5: ", "vertex x y z"},
      {"vertex 1 0 0", "vertex 1 0 nan", "a.stl:5: ", "finite"},
      {"vertex 1 0 0", "vertex 1 0 0 0", "a.stl:5: ", "vertex x y z"},
      {"vertex 1 0 0\n", "", "a.stl:6: ", "\"vertex\" is expected, not \"endloop\""},
      {"outer loop\n", "", "a.stl:3: ", "\"outer\" is expected"},
      {"endfacet\n", "endfacet\nfaces\n", "a.stl:9: ", "\"facet\" or \"endsolid\" is expected, not \"faces\""},
      {"endsolid", "", "a.stl:9: ", "cut off"},
      {"endsolid", "endsolid\nfacet", "a.stl:10: ", "\"solid\" is expected"},
  };
  const std::string good = kSolid + Facet("0 0 0", "1 0 0", "0 1 0") + "endsolid\n";
  for (const BadStl& bad : changes) {
    const auto mesh = Parse("a.stl", absl::StrReplaceAll(good, {{bad.from, bad.to}}), 1.0);
    EXPECT_EQ(mesh.status().code(), absl::StatusCode::kInvalidArgument) << bad.to;
    EXPECT_THAT(std::string(mesh.status().message()), StartsWith(bad.start)) << bad.from;
    EXPECT_THAT(std::string(mesh.status().message()), HasSubstr(bad.words)) << bad.from;
  }
  EXPECT_THAT(std::string(Parse("a.stl", "solid\nendsolid\n", 1.0).status().message()), HasSubstr("no triangles"));
}

TEST(Stl, ErrorsInBinaryNameTheByteAndTheFault) {
  Mesh mesh;
  mesh.vertices = Points::Identity(3, 3);
  mesh.triangles.resize(3, 1);
  mesh.triangles << 0, 1, 2;
  const std::string good = *Write("a.stl", mesh, 1.0);
  const std::string nan("\0\0\xc0\x7f", 4);
  const std::pair<std::string, const char*> files[] = {
      {good.substr(0, 100), "a.stl:byte 80: the file says 1 triangles, which take 134 bytes, but has 100"},
      {good + "\n", "a.stl:byte 80: the file says 1 triangles, which take 134 bytes, but has 135"},
      {good.substr(0, 70), "a.stl:byte 70: the file is neither an STL in text"},
      {std::string(84, '\0'), "a.stl:byte 80: the file says 0 triangles"},
      {std::string(good).replace(84 + 12 + 16, 4, nan), "a.stl:byte 108: triangle 0 has a corner that is not finite"},
  };
  for (const auto& [bytes, words] : files) {
    const auto read = Parse("a.stl", bytes, 1.0);
    EXPECT_EQ(read.status().code(), absl::StatusCode::kInvalidArgument) << words;
    EXPECT_THAT(std::string(read.status().message()), StartsWith(words));
  }
}

}  // namespace
}  // namespace phrenic::meshio
