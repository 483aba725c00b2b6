#include "server/mesh/ellipsoid.h"

#include <gtest/gtest.h>

#include <numbers>

#include "server/mesh/topology.h"

namespace phrenic {
namespace {

const Eigen::Vector3d kRadii(3, 2, 1);

TEST(Ellipsoid, IsClosedAndItsVolumeConverges) {
  const Mesh mesh = EllipsoidSurface({5, 6, 7}, kRadii, 24, false);
  const SurfaceTopology topology = AnalyseTopology(mesh);
  EXPECT_TRUE(topology.watertight());
  EXPECT_EQ(topology.components, 1);
  EXPECT_EQ(topology.genus(), 0);
  EXPECT_NEAR(SignedVolume(mesh.vertices, mesh.triangles), 4 * std::numbers::pi / 3 * 6, 0.01 * 25);
  const Points scaled = kRadii.cwiseInverse().asDiagonal() * (mesh.vertices.colwise() - Eigen::Vector3d(5, 6, 7));
  EXPECT_LT((scaled.colwise().norm().array() - 1).abs().maxCoeff(), 1e-12);
}

TEST(Ellipsoid, UpperHalfHasTheRimAsBoundary) {
  const Mesh mesh = EllipsoidSurface(Eigen::Vector3d::Zero(), kRadii, 6, true);
  const SurfaceTopology topology = AnalyseTopology(mesh);
  EXPECT_EQ(topology.boundary_edges, 24);
  EXPECT_EQ(mesh.regions.at("rim").size(), 24u);
  for (const int vertex : mesh.regions.at("rim")) EXPECT_EQ(mesh.vertices(2, vertex), 0);
  EXPECT_GE(mesh.vertices.row(2).minCoeff(), 0);
}

}  // namespace
}  // namespace phrenic
