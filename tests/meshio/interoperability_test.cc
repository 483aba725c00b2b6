// Interoperability: gmsh and VTK open the files written here.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

#include "server/mesh/ellipsoid.h"
#include "server/meshio/meshio.h"

namespace phrenic::meshio {
namespace {

using ::testing::HasSubstr;

bool Works(const std::string& command) { return std::system((command + " >/dev/null 2>&1").c_str()) == 0; }

// A path for the running test alone: tests run beside each other.
std::string Scratch(const std::string& ending) {
  return testing::TempDir() + testing::UnitTest::GetInstance()->current_test_info()->name() + ending;
}

std::string OutputOf(const std::string& command) {
  const std::string log = Scratch(".log");
  EXPECT_EQ(std::system((command + " >" + log + " 2>&1").c_str()), 0) << command;
  std::stringstream text;
  text << std::ifstream(log).rdbuf();
  return text.str();
}

// Writes an ellipsoid of 20 x 40 x 60 mm with 102 vertices and 200 triangles, in millimetres. Returns the path.
std::string WriteEllipsoid(const std::string& ending) {
  std::string path = Scratch(ending);
  const Mesh mesh = EllipsoidSurface({0, 0, 0.1}, {0.01, 0.02, 0.03}, 5, false);
  std::ofstream(path, std::ios::binary) << *Write(path, mesh, 1e-3);
  return path;
}

TEST(Interoperability, GmshOpensWrittenFiles) {
  if (!Works("command -v gmsh")) GTEST_SKIP() << "gmsh is not installed";
  const std::string geo = Scratch(".geo");
  for (const char* ending : {".msh", ".stl"}) {  // gmsh 4.8 does not read every PLY, and no OBJ
    std::ofstream(geo) << "Merge \"" << WriteEllipsoid(ending) << "\";\nPrintf(\"%g nodes\", Mesh.NbNodes);\n"
                       << "Printf(\"%g triangles\", Mesh.NbTriangles);\n";
    const std::string said = OutputOf("gmsh -parse_and_exit " + geo);
    EXPECT_THAT(said, HasSubstr("102 nodes")) << ending;
    EXPECT_THAT(said, HasSubstr("200 triangles")) << ending;
  }
}

TEST(Interoperability, VtkOpensWrittenFiles) {
  const std::string python = "/usr/bin/python3";  // Debian's Python, for which its VTK package is built
  if (!Works(python + " -c 'import vtk'")) GTEST_SKIP() << "VTK is not installed (python3-vtk9)";
  const std::string script = Scratch(".py");
  std::ofstream(script) << "import sys, vtk\n"
                           "for name, reader in (('.obj', vtk.vtkOBJReader()), ('.stl', vtk.vtkSTLReader()),\n"
                           "                     ('.ply', vtk.vtkPLYReader()), ('.vtk', vtk.vtkPolyDataReader()),\n"
                           "                     ('.vtp', vtk.vtkXMLPolyDataReader())):\n"
                           "    reader.SetFileName(sys.argv[1] + name)\n"
                           "    reader.Update()\n"
                           "    surface = reader.GetOutput()\n"
                           "    print(name, surface.GetNumberOfPoints(), surface.GetNumberOfCells(),\n"
                           "          ['%.3f' % x for x in surface.GetBounds()])\n";
  std::string stem;
  for (const std::string ending : {".obj", ".stl", ".ply", ".vtk", ".vtp"}) {
    const std::string path = WriteEllipsoid(ending);
    stem = path.substr(0, path.size() - ending.size());
  }
  std::string expected;
  for (const std::string ending : {".obj", ".stl", ".ply", ".vtk", ".vtp"}) {
    expected += ending + " 102 200 ['-10.000', '10.000', '-20.000', '20.000', '70.000', '130.000']\n";
  }
  EXPECT_EQ(OutputOf(python + " " + script + " " + stem), expected);
}

}  // namespace
}  // namespace phrenic::meshio
