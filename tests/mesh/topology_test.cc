#include "server/mesh/topology.h"

#include <gtest/gtest.h>

#include "tests/mesh/solids.h"

namespace phrenic {
namespace {

TEST(Topology, TetrahedronIsAWatertightSphere) {
  const SurfaceTopology topology = AnalyseTopology(Tetrahedron());
  EXPECT_EQ(topology.vertices, 4);
  EXPECT_EQ(topology.edges, 6);
  EXPECT_EQ(topology.triangles, 4);
  EXPECT_EQ(topology.components, 1);
  EXPECT_TRUE(topology.watertight());
  EXPECT_EQ(topology.genus(), 0);
  EXPECT_EQ(topology.degenerate_triangles, 0);
}

TEST(Topology, TorusHasGenusOne) {
  const SurfaceTopology topology = AnalyseTopology(Torus(2, 0.5, 16, 8));
  EXPECT_TRUE(topology.watertight());
  EXPECT_EQ(topology.components, 1);
  EXPECT_EQ(topology.genus(), 1);
}

TEST(Topology, OnlyAnOpenSurfaceHasABoundary) {
  EXPECT_TRUE(BoundaryVertices(Tetrahedron().triangles).empty());
  EXPECT_EQ(BoundaryVertices(Tetrahedron().triangles.rightCols(3)).size(), 3u);  // one face removed
  Triangles fan(3, 4);
  fan << 0, 0, 0, 0, 1, 2, 3, 4, 2, 3, 4, 1;
  EXPECT_EQ(BoundaryVertices(fan), (std::vector<int>{1, 2, 3, 4}));
}

TEST(Topology, GenusAddsOverComponents) {
  const SurfaceTopology topology = AnalyseTopology(Together(Torus(2, 0.5, 16, 8), Torus(3, 0.5, 9, 5)));
  EXPECT_EQ(topology.components, 2);
  EXPECT_EQ(topology.genus(), 2);
}

TEST(Topology, UnusedVerticesDoNotCount) {
  Mesh mesh = Tetrahedron();
  mesh.vertices.conservativeResize(3, 6);
  mesh.vertices.rightCols(2).setOnes();
  const SurfaceTopology topology = AnalyseTopology(mesh);
  EXPECT_EQ(topology.vertices, 4);
  EXPECT_EQ(topology.components, 1);
  EXPECT_EQ(topology.genus(), 0);
}

TEST(Topology, MissingTriangleLeavesThreeBoundaryEdges) {
  Mesh mesh = Tetrahedron();
  mesh.triangles.conservativeResize(3, 3);
  const SurfaceTopology topology = AnalyseTopology(mesh);
  EXPECT_EQ(topology.boundary_edges, 3);
  EXPECT_FALSE(topology.watertight());
}

TEST(Topology, FlippedTriangleIsMisorientedOnItsThreeEdges) {
  Mesh mesh = Tetrahedron();
  std::swap(mesh.triangles(0, 2), mesh.triangles(1, 2));
  const SurfaceTopology topology = AnalyseTopology(mesh);
  EXPECT_EQ(topology.misoriented_edges, 3);
  EXPECT_EQ(topology.boundary_edges, 0);
  EXPECT_FALSE(topology.watertight());
}

TEST(Topology, FinOnAnEdgeIsNotManifold) {
  Mesh mesh = Tetrahedron();
  mesh.vertices.conservativeResize(3, 5);
  mesh.vertices.col(4) << 2, 2, 2;
  mesh.triangles.conservativeResize(3, 5);
  mesh.triangles.col(4) << 0, 1, 4;
  const SurfaceTopology topology = AnalyseTopology(mesh);
  EXPECT_EQ(topology.non_manifold_edges, 1);
  EXPECT_EQ(topology.boundary_edges, 2);
  EXPECT_FALSE(topology.watertight());
}

TEST(Topology, RepeatedCornersAndSliversAreDegenerate) {
  Mesh mesh = Tetrahedron();
  mesh.vertices.conservativeResize(3, 5);
  mesh.vertices.col(4) << 0.5, 0, 0;  // on the edge 0-1
  mesh.triangles.conservativeResize(3, 6);
  mesh.triangles.col(4) << 0, 0, 1;
  mesh.triangles.col(5) << 0, 1, 4;
  EXPECT_EQ(AnalyseTopology(mesh).degenerate_triangles, 2);
}

TEST(Topology, EmptySurfaceHasZeroCounts) {
  const SurfaceTopology topology = AnalyseTopology(Mesh{});
  EXPECT_EQ(topology.vertices, 0);
  EXPECT_EQ(topology.components, 0);
  EXPECT_EQ(topology.genus(), 0);
}

TEST(Edges, EachOnceLowerIndexFirstSorted) {
  Edges expected(2, 6);
  expected << 0, 0, 0, 1, 1, 2, 1, 2, 3, 2, 3, 3;
  EXPECT_EQ(TriangleEdges(Tetrahedron().triangles), expected);
}

TEST(Edges, SpringsPreferTheMeshesOwnEdges) {
  Mesh mesh = Tetrahedron();
  EXPECT_EQ(SpringEdges(mesh).cols(), 6);
  mesh.edges.resize(2, 1);
  mesh.edges << 3, 1;
  EXPECT_EQ(SpringEdges(mesh), mesh.edges);
}

TEST(Volume, DoesNotDependOnThePosition) {
  EXPECT_NEAR(SignedVolume(Tetrahedron().vertices, Tetrahedron().triangles), 1.0 / 6, 1e-15);
  const Mesh far = Tetrahedron({10, -20, 30});
  EXPECT_NEAR(SignedVolume(far.vertices, far.triangles), 1.0 / 6, 1e-11);
}

TEST(Volume, IsNegativeInsideOut) {
  Mesh mesh = Tetrahedron();
  mesh.triangles.row(0).swap(mesh.triangles.row(1));
  EXPECT_NEAR(SignedVolume(mesh.vertices, mesh.triangles), -1.0 / 6, 1e-15);
}

TEST(Volume, OfAFineTorusFollowsPappus) {
  const Mesh torus = Torus(2, 0.5, 200, 100);
  const double pappus = 2 * std::numbers::pi * std::numbers::pi * 2 * 0.25;
  EXPECT_NEAR(SignedVolume(torus.vertices, torus.triangles), pappus, 2e-3 * pappus);
}

}  // namespace
}  // namespace phrenic
