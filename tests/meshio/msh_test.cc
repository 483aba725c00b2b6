#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "absl/strings/str_replace.h"
#include "server/meshio/meshio.h"
#include "tests/meshio/malformed.h"

namespace phrenic::meshio {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Node numbers are neither ordered nor contiguous, as in a part of a larger mesh.
constexpr char kSheet[] =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
    "$PhysicalNames\n2\n2 7 \"central tendon\"\n1 8 \"rim\"\n$EndPhysicalNames\n"
    "$Nodes\n5\n100 0 0 0\n7 1 0 0\n3000000000 1 1 0\n2 0 1 0\n5 2 2 2\n$EndNodes\n"
    "$Elements\n5\n1 15 2 0 1 100\n2 1 2 8 1 100 7\n3 2 2 7 1 100 7 3000000000\n4 2 0 100 3000000000 2\n"
    "5 4 2 7 1 100 7 2 5\n$EndElements\n"
    "$NodeData\n1\n\"u\"\n$EndNodeData\n";

std::string Sheet(const std::string& from, const std::string& to) { return absl::StrReplaceAll(kSheet, {{from, to}}); }

TEST(Msh, NodesKeepTheFilesOrderWhateverTheirNumbers) {
  const auto mesh = Parse("a.msh", kSheet, 0.5);
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  ASSERT_EQ(mesh->vertices.cols(), 5);
  EXPECT_EQ(mesh->vertices.col(2), Eigen::Vector3d(0.5, 0.5, 0));
  ASSERT_EQ(mesh->triangles.cols(), 2);
  EXPECT_EQ(mesh->triangles.col(0), Eigen::Vector3i(0, 1, 2));
  EXPECT_EQ(mesh->triangles.col(1), Eigen::Vector3i(0, 2, 3));
  EXPECT_EQ(mesh->edges.cols(), 0) << "lines beside triangles are outlines";
}

TEST(Msh, NamedPhysicalSurfacesBecomeRegions) {
  const auto mesh = Parse("a.msh", kSheet, 1.0);
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  ASSERT_EQ(mesh->regions.size(), 1U);
  EXPECT_THAT(mesh->regions.at("central tendon"), ElementsAre(0, 1, 2));
}

TEST(Msh, LineEndingsDoNotMatter) {
  const auto mesh = Parse("a.msh", Sheet("\n", "\r\n"), 1.0);
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_EQ(mesh->triangles.cols(), 2);
}

TEST(Msh, QuadrilateralsAreSplitAndLinesAloneAreANetwork) {
  const auto quadrilateral = Parse("a.msh", Sheet("4 2 0 100 3000000000 2\n", "4 3 0 100 7 3000000000 2\n"), 1.0);
  ASSERT_TRUE(quadrilateral.ok()) << quadrilateral.status();
  EXPECT_EQ(quadrilateral->triangles.cols(), 3);
  const auto network =
      Parse("a.msh", Sheet("3 2 2 7 1 100 7 3000000000\n4 2 0 100 3000000000 2\n", "3 1 0 7 2\n4 1 0 2 5\n"), 1.0);
  ASSERT_TRUE(network.ok()) << network.status();
  ASSERT_EQ(network->edges.cols(), 3);
  EXPECT_EQ(network->edges.col(0), Eigen::Vector2i(0, 1));
}

TEST(Msh, OtherVersionsAreRejectedWithAConversionHint) {
  for (const char* format : {"4.0 0 8", "1.0 0 8", "3.0 0 8"}) {
    ExpectParseError("a.msh", Sheet("2.2 0 8", format), "a.msh:2: ", "only 2.0 to 2.2 and 4.1");
    ExpectParseError("a.msh", Sheet("2.2 0 8", format), "a.msh:2: ", "-format msh22");
  }
}

TEST(Msh, ErrorsNameTheLineAndTheProblem) {
  ExpectParseErrors(
      "a.msh", kSheet,
      {
          {"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n", "", "a.msh:1: ", "does not start with $MeshFormat"},
          {"$MeshFormat\n", "", "a.msh:1: ", "a section"},
          {"$Nodes\n5\n", "$Nodes\n4\n", "a.msh:16: ", "says 4 rows but has 5"},
          {"$Nodes\n5\n", "$Nodes\n9000000000000000000\n", "a.msh:16: ", "says 9000000000000000000 rows but has 5"},
          {"$Nodes\n5\n", "$Nodes\nfive\n", "a.msh:10: ", "count is missing"},
          {"7 1 0 0\n", "7 1 zero 0\n", "a.msh:12: ", "number x y z"},
          {"7 1 0 0\n", "7 1 inf 0\n", "a.msh:12: ", "finite"},
          {"7 1 0 0\n", "100 1 0 0\n", "a.msh:12: ", "node 100 is there twice"},
          {"100 7 3000000000\n", "100 7 99\n", "a.msh:21: ", "node 99, which is not among the 5"},
          {"100 7 3000000000\n", "100 7\n", "a.msh:21: ", "needs 3 node numbers"},
          {"3 2 2 7 1 ", "3 2 -2 7 1 ", "a.msh:21: ", "count-of-tags"},
          {"3 2 2 7 1 ", "3 2 2147483648 7 1 ", "a.msh:21: ", "count-of-tags"},
          {"2 7 \"central tendon\"", "2 7 central", "a.msh:6: ", "double quotes"},
          {"$EndElements\n", "", "a.msh:24: ", "an element is written"},
      });
}

TEST(Msh, AFileWithoutASurfaceGetsAHintToGenerateOne) {
  const auto mesh = Parse("a.msh",
                          "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n1 0 0 0\n$EndNodes\n"
                          "$Elements\n1\n1 15 0 1\n$EndElements\n",
                          1.0);
  EXPECT_THAT(std::string(mesh.status().message()), HasSubstr("only 1 elements of other types"));
  EXPECT_THAT(std::string(mesh.status().message()), HasSubstr("-order 1"));
}

TEST(Msh, EveryTruncationGivesAValidMeshOrAnError) { ExpectTruncationsHandled("a.msh", kSheet); }

TEST(Msh, EveryGarbledByteGivesAValidMeshOrAnError) {
  ExpectGarbledBytesHandled("a.msh", kSheet, std::string_view("\0\n-9$\"\xff", 7));
}

}  // namespace
}  // namespace phrenic::meshio
