#include "server/mesh/tetrahedra.h"

#include <gtest/gtest.h>

#include "server/mesh/ellipsoid.h"
#include "server/mesh/topology.h"

namespace phrenic {
namespace {

double VolumeOf(const Mesh& mesh) {
  double volume = 0;
  for (Eigen::Index t = 0; t < mesh.tetrahedra.cols(); ++t) {
    EXPECT_GT(TetrahedronVolume(mesh, t), 0) << "tetrahedron " << t;
    volume += TetrahedronVolume(mesh, t);
  }
  return volume;
}

TEST(FillCells, FillsABoxWithoutGapsOrOverlaps) {
  const Mesh mesh = FillCells({{1, 2, 3}, {0.5, 0.25, 0.2}, {4, 3, 5}}, [](const Eigen::Vector3d&) { return true; });
  EXPECT_EQ(mesh.vertices.cols(), 5 * 4 * 6);
  EXPECT_EQ(mesh.tetrahedra.cols(), 4 * 3 * 5 * 5);
  EXPECT_NEAR(VolumeOf(mesh), 2 * 0.75 * 1, 1e-12);
  const SurfaceTopology topology = AnalyseTopology(mesh);
  EXPECT_TRUE(topology.watertight());
  EXPECT_EQ(topology.genus(), 0);
  EXPECT_EQ(topology.triangles, 2 * 2 * (4 * 3 + 3 * 5 + 5 * 4));
  EXPECT_NEAR(SignedVolume(mesh.vertices, mesh.triangles), 1.5, 1e-12);
}

TEST(FillCells, ApproximatesTheVolumeInsideASurface) {
  const Mesh surface = EllipsoidSurface({0, 0, 0}, {3, 2, 1}, 12, false);
  const auto inside = [&](const Eigen::Vector3d& x) { return WindingNumber(surface, x) > 0.5; };
  const Mesh solid = FillCells({{-3, -2, -1}, {0.1, 0.1, 0.1}, {60, 40, 20}}, inside);
  const double exact = SignedVolume(surface.vertices, surface.triangles);
  EXPECT_NEAR(VolumeOf(solid), exact, 0.01 * exact);
  EXPECT_EQ(AnalyseTopology(solid).boundary_edges, 0);
}

TEST(WindingNumber, IsOneInsideAndZeroOutside) {
  const Mesh surface = EllipsoidSurface({1, 0, 0}, {3, 2, 1}, 6, false);
  EXPECT_NEAR(WindingNumber(surface, {1, 0.5, 0.2}), 1, 1e-12);
  EXPECT_NEAR(WindingNumber(surface, {1, 0.5, 1.2}), 0, 1e-12);
  EXPECT_NEAR(WindingNumber(surface, {-3, 0, 0}), 0, 1e-12);
}

}  // namespace
}  // namespace phrenic
