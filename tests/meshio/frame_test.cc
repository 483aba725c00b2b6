// The frame that files state, in every spelling and every format: read, or refused, never misread.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "server/meshio/meshio.h"
#include "server/meshio/motion.h"

namespace phrenic::meshio {
namespace {

using testing::AnyOf;
using testing::HasSubstr;

// A file of one triangle with a corner at (1, 2, 3), and a place for a statement.
struct Place {
  const char* what;
  const char* name;
  std::string text;  // "@" is the statement
};

std::string CharacterCodes(const std::string& text) {
  std::string codes;
  for (const char c : text) absl::StrAppend(&codes, static_cast<int>(c), " ");
  return codes + "0";
}

std::string BinaryStl(std::string header) {
  header.resize(80, '\0');
  const float numbers[12] = {0, 0, 0, 1, 2, 3, 0, 0, 0, 0, 4, 0};
  std::string bytes = header + std::string("\1\0\0\0", 4);
  bytes.append(reinterpret_cast<const char*>(numbers), sizeof(numbers));
  return bytes + std::string(2, '\0');
}

constexpr char kPly[] =
    "element vertex 3\nproperty double x\nproperty double y\nproperty double z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n1 2 3\n0 0 0\n0 4 0\n3 0 1 2\n";
constexpr char kVtk[] = "POINTS 3 double\n1 2 3 0 0 0 0 4 0\nPOLYGONS 1 4\n3 0 1 2\n";
constexpr char kMsh2[] =
    "$Nodes\n3\n1 1 2 3\n2 0 0 0\n3 0 4 0\n$EndNodes\n$Elements\n1\n1 2 2 0 1 1 2 3\n$EndElements\n";
constexpr char kMsh4[] =
    "$Nodes\n1 3 1 3\n2 1 0 3\n1\n2\n3\n1 2 3\n0 0 0\n0 4 0\n$EndNodes\n"
    "$Elements\n1 1 1 1\n2 1 2 1\n1 1 2 3\n$EndElements\n";

std::vector<Place> Places() {
  return {
      {"comment", "a.obj", "# @\nv 1 2 3\nv 0 0 0\nv 0 4 0\nf 1 2 3\n"},
      {"comment without a blank", "a.obj", "#@\nv 1 2 3\nv 0 0 0\nv 0 4 0\nf 1 2 3\n"},
      {"comment after a vertex", "a.obj", "v 1 2 3 # @\nv 0 0 0\nv 0 4 0\nf 1 2 3\n"},
      {"comment at the end", "a.obj", "v 1 2 3\nv 0 0 0\nv 0 4 0\nf 1 2 3\n# exported: @"},
      {"comment", "a.ply", absl::StrCat("ply\nformat ascii 1.0\ncomment made by hand; @\n", kPly)},
      {"obj_info", "a.ply", absl::StrCat("ply\nformat ascii 1.0\nobj_info @\n", kPly)},
      {"name", "a.stl",
       "solid part @\nfacet normal 0 0 0\nouter loop\nvertex 1 2 3\nvertex 0 0 0\nvertex 0 4 0\nendloop\nendfacet\n"
       "endsolid\n"},
      {"header", "b.stl", "@"},
      {"title", "a.vtk", absl::StrCat("# vtk DataFile Version 4.2\nwritten: @\nASCII\nDATASET POLYDATA\n", kVtk)},
      {"field", "a.vtk",
       absl::StrCat("# vtk DataFile Version 4.2\nx\nASCII\nDATASET POLYDATA\nFIELD FieldData 1\nSPACE 1 1 string\n@\n",
                    kVtk)},
      {"field in lower case", "a.vtk",
       absl::StrCat("# vtk DataFile Version 4.2\nx\nASCII\nDATASET POLYDATA\nFIELD FieldData 1\nspace 1 1 string\n@\n",
                    kVtk)},
      {"field", "a.vtp",
       "<VTKFile type='PolyData'><PolyData><FieldData><Array type='String' Name='SPACE' format='ascii'>@</Array>"
       "</FieldData><Piece NumberOfPoints='3' NumberOfPolys='1'><Points><DataArray type='Float64' format='ascii'>"
       "1 2 3 0 0 0 0 4 0</DataArray></Points><Polys><DataArray type='Int64' Name='connectivity' format='ascii'>0 1 2"
       "</DataArray><DataArray type='Int64' Name='offsets' format='ascii'>3</DataArray></Polys></Piece></PolyData>"
       "</VTKFile>"},
      {"comments", "a.msh",
       absl::StrCat("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Comments\nby hand\n@\n$EndComments\n", kMsh2)},
      {"comments", "b.msh", absl::StrCat("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Comments\n@\n$EndComments\n", kMsh4)},
  };
}

std::string With(const Place& place, const std::string& statement) {
  if (place.name == std::string("b.stl")) return BinaryStl(statement);
  const bool codes = place.name == std::string("a.vtp");
  return absl::StrReplaceAll(place.text, {{"@", codes ? CharacterCodes(statement) : statement}});
}

TEST(Frames, AreReadInEverySpelling) {
  for (const Place& place : Places()) {
    for (const char* frame : {"RAS", "ras", "Ras", "RAS+", "right-anterior-superior", "\"RAS\""}) {
      for (const char* space : {"SPACE=", "space=", "Space = ", "SPACE: ", "space ", "SPACE\t=\t"}) {
        const std::string statement = absl::StrCat(space, frame);
        const auto surface = ParseSurface(place.name, With(place, statement), 1);
        ASSERT_TRUE(surface.ok()) << place.what << ": " << statement << ": " << surface.status();
        EXPECT_EQ(surface->frame, Frame::kRas) << place.name << " " << place.what << ": " << statement;
        EXPECT_EQ(surface->mesh.vertices.col(0), Eigen::Vector3d(-1, -2, 3)) << place.name << ": " << statement;
      }
    }
    for (const char* statement : {"space=lps", "SPACE=LPS", "SPACE: left-posterior-superior", "SPACE=LPS."}) {
      const auto surface = ParseSurface(place.name, With(place, statement), 1);
      ASSERT_TRUE(surface.ok()) << place.what << ": " << statement << ": " << surface.status();
      EXPECT_EQ(surface->frame, Frame::kLps) << place.name << ": " << statement;
      EXPECT_EQ(surface->mesh.vertices.col(0), Eigen::Vector3d(1, 2, 3)) << place.name << ": " << statement;
    }
  }
}

TEST(Frames, ThatAreNotSupportedAreRefused) {
  for (const Place& place : Places()) {
    for (const char* statement : {"SPACE=RAST", "SPACE=RASP", "SPACE=LAS", "space=ras_x", "SPACE=", "SPACE=scanner-xyz",
                                  "SPACE=LPS SPACE=RAS", "SPACE=RAS, that is, SPACE=LPS", "SPACE=RA S"}) {
      const auto surface = ParseSurface(place.name, With(place, statement), 1);
      ASSERT_FALSE(surface.ok()) << place.name << " " << place.what << ": " << statement;
      EXPECT_THAT(std::string(surface.status().message()), AnyOf(HasSubstr("SPACE=LPS or SPACE=RAS")))
          << place.name << " " << place.what << ": " << statement;
    }
  }
}

TEST(Frames, AreNotGuessedFromOtherWords) {
  for (const char* words : {"whitespace = none", "namespace=ras", "SPACES=RAS", "spacer: 3", "a space here", "RAS"}) {
    for (const Place& place : Places()) {
      if (place.what == std::string("field") || place.what == std::string("field in lower case")) continue;
      const auto surface = ParseSurface(place.name, With(place, words), 1);
      ASSERT_TRUE(surface.ok()) << place.name << ": " << words << ": " << surface.status();
      EXPECT_EQ(surface->frame, Frame::kUnspecified) << place.name << ": " << words;
    }
  }
}

TEST(Frames, OfFieldsThatAreNoTextAreRefused) {
  const std::string vtk = absl::StrCat(
      "# vtk DataFile Version 4.2\nx\nASCII\nDATASET POLYDATA\nFIELD FieldData 1\nSPACE 1 1 int\n7\n", kVtk);
  EXPECT_FALSE(ParseSurface("a.vtk", vtk, 1).ok());
  for (const Place& place : Places()) {
    if (place.name != std::string("a.vtp")) continue;
    EXPECT_FALSE(ParseSurface("a.vtp", absl::StrReplaceAll(place.text, {{"@", "82 65 x"}}), 1).ok());
    EXPECT_FALSE(ParseSurface("a.vtp", absl::StrReplaceAll(place.text, {{"'String'", "'Int8'"}, {"@", "1"}}), 1).ok());
  }
}

TEST(Frames, OfMotionsTurnTheirDisplacements) {
  const std::string text =
      absl::StrCat("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Comments\nSPACE=RAS\n$EndComments\n", kMsh2,
                   "$NodeData\n1\n\"displacement\"\n1\n0.5\n3\n0\n3\n3\n1 10 20 30\n2 0 0 0\n3 0 0 0\n$EndNodeData\n");
  const auto motion = ParseMotion("a.msh", text, 1);
  ASSERT_TRUE(motion.ok()) << motion.status();
  EXPECT_EQ(motion->mesh.vertices.col(0), Eigen::Vector3d(-1, -2, 3));
  EXPECT_EQ(motion->displacements[0].col(0), Eigen::Vector3d(-10, -20, 30));
}

}  // namespace
}  // namespace phrenic::meshio
