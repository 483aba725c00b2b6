#include "server/compare/inspection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "server/mesh/ellipsoid.h"

namespace phrenic::compare {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

v1::SurfaceReport Report(const Mesh& mesh) { return Inspect("a.stl", {mesh, meshio::Frame::kUnspecified}, 1); }

Mesh Ball() { return EllipsoidSurface({0, 0, 0}, {0.05, 0.05, 0.05}, 5, false); }

// A torus of n x n squares, each two triangles.
Mesh Torus(int n) {
  Mesh mesh;
  mesh.vertices.resize(3, n * n);
  mesh.triangles.resize(3, 2 * n * n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double u = 2 * M_PI * i / n, v = 2 * M_PI * j / n, r = 0.1 + 0.03 * std::cos(v);
      mesh.vertices.col(i * n + j) << r * std::cos(u), r * std::sin(u), 0.03 * std::sin(v);
      const int a = i * n + j, b = (i + 1) % n * n + j, c = (i + 1) % n * n + (j + 1) % n, d = i * n + (j + 1) % n;
      mesh.triangles.col(2 * a) << a, b, c;
      mesh.triangles.col(2 * a + 1) << a, c, d;
    }
  }
  return mesh;
}

// Joins two meshes, the second translated by `shift`.
Mesh Together(const Mesh& a, const Mesh& b, const Eigen::Vector3d& shift) {
  Mesh mesh;
  mesh.vertices.resize(3, a.vertices.cols() + b.vertices.cols());
  mesh.vertices << a.vertices, b.vertices.colwise() + shift;
  mesh.triangles.resize(3, a.triangles.cols() + b.triangles.cols());
  mesh.triangles << a.triangles, b.triangles.array() + static_cast<int>(a.vertices.cols());
  return mesh;
}

TEST(Inspection, AClosedBallNeedsNoRepair) {
  const v1::SurfaceReport report = Report(Ball());
  EXPECT_EQ(report.euler_characteristic(), 2);
  ASSERT_EQ(report.components_size(), 1);
  EXPECT_TRUE(report.components(0).closed());
  EXPECT_EQ(report.components(0).genus(), 0);
  EXPECT_NEAR(report.volume_ml(), 4.0 / 3 * M_PI * 125, 32)
      << "a ball of 5 cm radius; the facets take 6 % of its volume";
  EXPECT_NEAR(report.area_mm2(), 4 * M_PI * 2500, 1500);
  EXPECT_EQ(report.likely_unit(), "mm");
  EXPECT_NEAR(report.greatest_mm(2), 50, 1e-9);
  EXPECT_NEAR(report.least_mm(0), -50, 1e-9);
  EXPECT_THAT(report.repairs(), IsEmpty());
  EXPECT_THAT(report.refusals(), IsEmpty());
}

TEST(Inspection, EachComponentHasItsOwnGenus) {
  const v1::SurfaceReport report = Report(Together(Ball(), Torus(12), {0.5, 0, 0}));
  ASSERT_EQ(report.components_size(), 2);
  EXPECT_EQ(report.components(0).triangles(), 288) << "the largest first";
  EXPECT_EQ(report.components(0).genus(), 1);
  EXPECT_EQ(report.components(1).genus(), 0);
  EXPECT_NEAR(report.volume_ml(), report.components(0).volume_ml() + report.components(1).volume_ml(), 1e-9);
}

TEST(Inspection, WhereTwoBallsTouchInAPointAVertexIsPinched) {
  Mesh mesh = Together(Ball(), Ball(), {0.1, 0, 0});
  EXPECT_EQ(Report(mesh).pinched_vertices(), 0);
  const int shared = 5, other = 7 + static_cast<int>(Ball().vertices.cols());
  for (int& corner : mesh.triangles.reshaped()) corner = corner == other ? shared : corner;
  const v1::SurfaceReport report = Report(mesh);
  EXPECT_EQ(report.pinched_vertices(), 1);
  ASSERT_EQ(report.components_size(), 1);
  EXPECT_FALSE(report.components(0).has_genus());
  EXPECT_THAT(report.repairs(), testing::Contains(HasSubstr("touch in a point")));
}

TEST(Inspection, CountsAndNamesDefects) {
  Mesh mesh = Ball();
  mesh.triangles.col(0).swap(mesh.triangles.col(7));  // order does not matter
  std::swap(mesh.triangles(0, 3), mesh.triangles(1, 3));
  EXPECT_EQ(Report(mesh).misoriented_edges(), 3);
  EXPECT_FALSE(Report(mesh).has_volume_ml());
  EXPECT_THAT(Report(mesh).repairs(), ElementsAre(HasSubstr("3 edges join triangles of opposite orientation")));

  mesh = Ball();
  mesh.triangles = mesh.triangles.rightCols(mesh.triangles.cols() - 1).eval();
  EXPECT_THAT(Report(mesh).repairs(), ElementsAre(HasSubstr("3 edges are open")));
  EXPECT_FALSE(Report(mesh).components(0).has_genus());

  mesh = Ball();
  mesh.triangles.row(0).swap(mesh.triangles.row(1));
  EXPECT_LT(Report(mesh).volume_ml(), 0);
  EXPECT_THAT(Report(mesh).repairs(), ElementsAre(HasSubstr("1 closed components face inwards")));
  EXPECT_THAT(Report(mesh).refusals(), ElementsAre(HasSubstr("a solid that fills it"), HasSubstr("a lung")));

  mesh = Together(Ball(), Ball(), {0, 0, 0});
  EXPECT_EQ(Report(mesh).duplicate_vertices(), Ball().vertices.cols());
  EXPECT_THAT(Report(mesh).refusals(), ElementsAre(HasSubstr("rigid links")));
}

TEST(Inspection, DegenerateTrianglesUnusedVerticesAndSharedEdgesAreCounted) {
  Mesh mesh;
  mesh.vertices.resize(3, 6);
  mesh.vertices << 0, 1, 0, 0, 2, 9, 0, 0, 1, 0, 0, 9, 0, 0, 0, 1, 0, 9;
  mesh.triangles.resize(3, 4);
  mesh.triangles << 0, 1, 0, 0, 1, 0, 1, 1, 2, 3, 4, 1;  // (0 1 2), (1 0 3), (0 1 4) flat, (0 1 1)
  const v1::SurfaceReport report = Report(mesh);
  EXPECT_EQ(report.degenerate_triangles(), 2);
  EXPECT_EQ(report.unused_vertices(), 1);
  EXPECT_EQ(report.non_manifold_edges(), 1);
  EXPECT_FALSE(report.components(0).closed());
}

TEST(Inspection, TheLikelyUnitIsThatOfABodyPart) {
  EXPECT_EQ(LikelyUnit(250), "mm");
  EXPECT_EQ(LikelyUnit(25), "cm");
  EXPECT_EQ(LikelyUnit(0.25), "m");
  EXPECT_EQ(LikelyUnit(2), "");
  EXPECT_EQ(LikelyUnit(25000), "");
  Mesh metres = Ball();
  metres.vertices *= 1e-3;  // a file in metres, read as millimetres
  EXPECT_THAT(Report(metres).repairs(), ElementsAre(HasSubstr("body part in m, but mm are assumed")));
}

TEST(Inspection, ANetworkHasNoTriangles) {
  Mesh wire;
  wire.vertices = Points::Identity(3, 3);
  wire.edges.resize(2, 1);
  wire.edges << 0, 2;
  const v1::SurfaceReport report = Report(wire);
  EXPECT_EQ(report.network_edges(), 1);
  EXPECT_EQ(report.unused_vertices(), 1);
  EXPECT_THAT(report.refusals(), testing::Contains(HasSubstr("has no triangles and cannot be a contact surface")));
}

// Compares boundary edges, non-manifold edges, components, area and volume with VTK.
TEST(Inspection, VtkCountsTheSameOnRealLungs) {
  const std::string folder = std::string(PHRENIC_SHARED_DIR) + "/data/thorax/lungs";
  const std::string python = "/usr/bin/python3";  // Debian's interpreter, for which its VTK is built
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the anatomical surfaces are missing";
  if (std::system((python + " -c 'import vtk' >/dev/null 2>&1").c_str()) != 0) {
    GTEST_SKIP() << "VTK is not installed (python3-vtk9)";
  }
  const std::string script = std::string(PHRENIC_SOURCE_DIR) + "/tests/compare/judges/vtk_topology.py";
  const std::string log = testing::TempDir() + "phrenic_topology.txt";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const auto surface = meshio::ReadSurface(entry.path().string(), 1e-3);
    ASSERT_TRUE(surface.ok()) << surface.status();
    const v1::SurfaceReport report = Inspect(entry.path().string(), *surface, 1);
    ASSERT_EQ(std::system((python + " " + script + " " + entry.path().string() + " >" + log).c_str()), 0);
    int boundary = -1, non_manifold = -1, components = -1;
    double area = 0, volume = 0;
    ASSERT_TRUE(std::ifstream(log) >> boundary >> non_manifold >> components >> area >> volume);
    EXPECT_EQ(report.boundary_edges(), boundary) << entry.path();
    EXPECT_EQ(report.non_manifold_edges(), non_manifold) << entry.path();
    EXPECT_EQ(report.components_size(), components) << entry.path();
    EXPECT_NEAR(report.area_mm2(), area, 1e-5 * area) << entry.path();
    if (report.has_volume_ml()) {
      EXPECT_NEAR(std::abs(report.volume_ml()), volume * 1e-3, 1e-4 * volume * 1e-3) << entry.path();
    }
  }
}

}  // namespace
}  // namespace phrenic::compare
