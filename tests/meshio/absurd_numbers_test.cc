// Numbers that are finite but no lengths, and edges without a length, in every reader.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "server/meshio/meshio.h"
#include "server/meshio/motion.h"

namespace phrenic::meshio {
namespace {

using testing::HasSubstr;

struct Text {
  const char* name;
  const char* text;  // "@" is a coordinate; "%" the number of both ends of an edge
};

constexpr Text kTriangles[] = {
    {"a.obj", "v @ 2 3\nv 0 0 0\nv 0 4 0\nf 1 2 3\n"},
    {"a.ply",
     "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\n"
     "element face 1\nproperty list uchar int vertex_indices\nend_header\n@ 2 3\n0 0 0\n0 4 0\n3 0 1 2\n"},
    {"a.stl",
     "solid\nfacet normal 0 0 0\nouter loop\nvertex @ 2 3\nvertex 0 0 0\nvertex 0 4 0\nendloop\nendfacet\nendsolid\n"},
    {"a.vtk",
     "# vtk DataFile Version 4.2\nx\nASCII\nDATASET POLYDATA\nPOINTS 3 double\n@ 2 3 0 0 0 0 4 0\n"
     "POLYGONS 1 4\n3 0 1 2\n"},
    {"a.vtp",
     "<VTKFile type='PolyData'><PolyData><Piece NumberOfPoints='3' NumberOfPolys='1'><Points>"
     "<DataArray type='Float64' format='ascii'>@ 2 3 0 0 0 0 4 0</DataArray></Points><Polys><DataArray type='Int64' "
     "Name='connectivity' format='ascii'>0 1 2</DataArray><DataArray type='Int64' Name='offsets' format='ascii'>3"
     "</DataArray></Polys></Piece></PolyData></VTKFile>"},
    {"a.msh",
     "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 @ 2 3\n2 0 0 0\n3 0 4 0\n$EndNodes\n"
     "$Elements\n1\n1 2 2 0 1 1 2 3\n$EndElements\n"},
    {"b.msh",
     "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 3 1 3\n2 1 0 3\n1\n2\n3\n@ 2 3\n0 0 0\n0 4 0\n$EndNodes\n"
     "$Elements\n1 1 1 1\n2 1 2 1\n1 1 2 3\n$EndElements\n"},
};

constexpr Text kNetworks[] = {
    {"a.obj", "v 1 2 3\nv 0 0 0\nl 1 2\nl % %\n"},
    {"a.ply",
     "ply\nformat ascii 1.0\nelement vertex 2\nproperty double x\nproperty double y\nproperty double z\n"
     "element edge 2\nproperty int vertex1\nproperty int vertex2\nend_header\n1 2 3\n0 0 0\n0 1\n% %\n"},
    {"a.vtk",
     "# vtk DataFile Version 4.2\nx\nASCII\nDATASET POLYDATA\nPOINTS 2 double\n1 2 3 0 0 0\n"
     "LINES 2 6\n2 0 1\n2 % %\n"},
    {"a.msh",
     "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n2\n1 1 2 3\n2 0 0 0\n$EndNodes\n"
     "$Elements\n2\n1 1 2 0 1 1 2\n2 1 2 0 1 % %\n$EndElements\n"},
};

TEST(Readers, RefuseCoordinatesThatAreNoLengths) {
  for (const Text& file : kTriangles) {
    for (const char* number : {"1e200", "-1e200", "1e13", "nan", "inf", "-inf", "1e999"}) {
      const auto mesh = Parse(file.name, absl::StrReplaceAll(file.text, {{"@", number}}), 1e-3);
      EXPECT_EQ(mesh.status().code(), absl::StatusCode::kInvalidArgument) << file.name << " " << number;
    }
    EXPECT_TRUE(Parse(file.name, absl::StrReplaceAll(file.text, {{"@", "1e8"}}), 1e-3).ok()) << file.name;
    const auto huge = Parse(file.name, absl::StrReplaceAll(file.text, {{"@", "1e200"}}), 1e-3);
    EXPECT_THAT(std::string(huge.status().message()), HasSubstr("1e+197; at most 1e+09 is accepted")) << file.name;
  }
}

TEST(Readers, RefuseEdgesFromAVertexToItself) {
  for (const Text& file : kNetworks) {
    const auto mesh = Parse(file.name, absl::StrReplaceAll(file.text, {{"%", "1"}}), 1);
    ASSERT_EQ(mesh.status().code(), absl::StatusCode::kInvalidArgument) << file.name;
    EXPECT_THAT(std::string(mesh.status().message()), HasSubstr("with itself; remove it")) << file.name;
  }
}

TEST(Readers, RefuseMotionsThatAreNone) {
  const std::string text =
      absl::StrCat(absl::StrReplaceAll(kTriangles[5].text, {{"@", "1"}}),
                   "$NodeData\n1\n\"displacement\"\n1\n@\n3\n0\n3\n3\n1 # 0 0\n2 0 0 0\n3 0 0 0\n$EndNodeData\n");
  const auto read = [&](const char* time, const char* shift) {
    return ParseMotion("a.msh", absl::StrReplaceAll(text, {{"@", time}, {"#", shift}}), 1).status();
  };
  EXPECT_TRUE(read("0.5", "2").ok());
  for (const char* absurd : {"1e200", "-1e200", "nan", "1e10"}) {
    EXPECT_EQ(read(absurd, "2").code(), absl::StatusCode::kInvalidArgument) << "time " << absurd;
    EXPECT_EQ(read("0.5", absurd).code(), absl::StatusCode::kInvalidArgument) << "displacement " << absurd;
  }
}

}  // namespace
}  // namespace phrenic::meshio
