#include "server/mesh/repair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "server/mesh/topology.h"
#include "tests/mesh/solids.h"

namespace phrenic {
namespace {

using testing::ElementsAre;

constexpr double kNear = 1e-6;

Mesh Ring() { return Torus(2, 0.5, 16, 8); }

double EnclosedBy(const Mesh& mesh) { return SignedVolume(mesh.vertices, mesh.triangles); }

void ExpectIntactRing(const Mesh& mesh, const char* what) {
  const SurfaceTopology topology = AnalyseTopology(mesh);
  EXPECT_TRUE(topology.watertight()) << what;
  EXPECT_EQ(topology.genus(), 1) << what;
  EXPECT_EQ(topology.degenerate_triangles, 0) << what;
  EXPECT_NEAR(EnclosedBy(mesh), EnclosedBy(Ring()), 1e-5) << what;
}

// Returns a triangle soup: every triangle has its own vertices, each displaced by up to `off` per axis.
Mesh Soup(const Mesh& mesh, double off) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> shift(-off, off);
  Mesh soup;
  soup.vertices.resize(3, mesh.triangles.size());
  soup.triangles.resize(3, mesh.triangles.cols());
  for (int i = 0; i < static_cast<int>(mesh.triangles.size()); ++i) {
    const Eigen::Vector3d away(shift(random), shift(random), shift(random));
    soup.vertices.col(i) = mesh.vertices.col(mesh.triangles(i % 3, i / 3)) + away;
    soup.triangles(i % 3, i / 3) = i;
  }
  return soup;
}

// Splits triangle t into three at the point with these barycentric weights.
void SplitTriangle(int t, const Eigen::Vector3d& weights, Mesh& mesh) {
  const Eigen::Vector3i corner = mesh.triangles.col(t);
  const auto vertex = static_cast<int>(mesh.vertices.cols());
  const auto last = mesh.triangles.cols();
  const Eigen::Vector3d point = mesh.vertices(Eigen::all, corner) * weights;
  mesh.vertices.conservativeResize(3, vertex + 1);
  mesh.vertices.col(vertex) = point;
  mesh.triangles.conservativeResize(3, last + 2);
  mesh.triangles.col(t) << corner[0], corner[1], vertex;
  mesh.triangles.col(last) << corner[1], corner[2], vertex;
  mesh.triangles.col(last + 1) << corner[2], corner[0], vertex;
}

TEST(Repair, AnIntactSurfaceIsUnchanged) {
  Mesh mesh = Ring();
  EXPECT_EQ(Weld(kNear, mesh), 0);
  EXPECT_EQ(DropSlivers(kNear, mesh), 0);
  EXPECT_EQ(DropFins(mesh), 0);
  EXPECT_EQ(Orient(mesh), 0);
  EXPECT_EQ(mesh.vertices, Ring().vertices);
  EXPECT_EQ(mesh.triangles, Ring().triangles);
}

TEST(Repair, WeldingClosesATriangleSoup) {
  for (const double off : {0.0, kNear / 4}) {
    Mesh mesh = Soup(Ring(), off);
    const auto soup = mesh.vertices.cols();
    EXPECT_EQ(Weld(off == 0 ? 0 : kNear, mesh), soup - Ring().vertices.cols());
    ExpectIntactRing(mesh, "welded");
  }
}

TEST(Repair, WeldingKeepsVerticesBeyondTheToleranceApart) {
  Mesh mesh = Soup(Tetrahedron(), 0);
  mesh.vertices(0, 0) += 2 * kNear;
  Weld(kNear, mesh);
  EXPECT_EQ(mesh.vertices.cols(), 5);
  EXPECT_EQ(AnalyseTopology(mesh).boundary_edges, 4);
}

TEST(Repair, RegionsFollowTheirVertices) {
  Mesh mesh = Soup(Tetrahedron(), 0);  // vertex i is a copy of the tetrahedron's triangles(i % 3, i / 3)
  mesh.regions["tip"] = {5, 8};        // both copies of its vertex 3
  Weld(0, mesh);
  ASSERT_EQ(mesh.regions["tip"].size(), 1u);
  EXPECT_EQ(mesh.vertices.col(mesh.regions["tip"][0]), Eigen::Vector3d::UnitZ());
}

TEST(Repair, SliversAreRemovedWithoutHoles) {
  Mesh mesh = Ring();
  SplitTriangle(3, {0.4, 0.6 - 1e-9, 1e-9}, mesh);       // a cap along an edge
  SplitTriangle(40, {1 - 2e-8, 1e-8, 1e-8}, mesh);       // needles at a corner
  SplitTriangle(80, {0.5, 0.5, 0}, mesh);                // zero area
  SplitTriangle(81, {1.0 / 3, 1.0 / 3, 1.0 / 3}, mesh);  // a good one
  EXPECT_GT(AnalyseTopology(mesh).degenerate_triangles, 0);
  EXPECT_GE(DropSlivers(kNear, mesh), 3);
  ExpectIntactRing(mesh, "without slivers");
  EXPECT_EQ(mesh.vertices.cols(), Ring().vertices.cols() + 3) << "the needles' one vertex is gone";
}

TEST(Repair, DuplicateTrianglesAreRemoved) {
  Mesh copied = Ring();
  copied.triangles.conservativeResize(3, copied.triangles.cols() + 2);
  copied.triangles.rightCols(2) = copied.triangles.leftCols(2);
  EXPECT_EQ(DropSlivers(kNear, copied), 2);
  EXPECT_EQ(copied.triangles, Ring().triangles);
  Mesh folded = Tetrahedron();  // plus two triangles of opposite winding on one edge
  folded.vertices.conservativeResize(3, 5);
  folded.vertices.col(4) << 2, 2, 2;
  folded.triangles.conservativeResize(3, 6);
  folded.triangles.rightCols(2) << 0, 4, 4, 0, 1, 1;
  EXPECT_EQ(DropSlivers(kNear, folded), 2);
  EXPECT_EQ(folded.triangles, Tetrahedron().triangles);
  EXPECT_EQ(folded.vertices.cols(), 4);
}

TEST(Repair, FinsAreRemovedAndSheetsKept) {
  Mesh mesh = Ring();
  mesh.vertices.conservativeResize(3, mesh.vertices.cols() + 1);
  mesh.vertices.rightCols(1) << 0, 0, 9;
  const auto vertex = static_cast<int>(mesh.vertices.cols()) - 1;
  mesh.triangles.conservativeResize(3, mesh.triangles.cols() + 1);
  mesh.triangles.rightCols(1) << mesh.triangles(0, 0), mesh.triangles(1, 0), vertex;
  EXPECT_EQ(DropFins(mesh), 1);
  EXPECT_EQ(mesh.triangles, Ring().triangles);
  Mesh sheet = Tetrahedron();
  sheet.triangles.conservativeResize(3, 3);
  EXPECT_EQ(DropFins(sheet), 0);
}

TEST(Repair, OrientingMakesWindingsConsistentAndOutward) {
  Mesh small = Ring();
  small.vertices.row(0).array() += 20;
  const Mesh good = Together(Ring(), small);
  for (const unsigned seed : {1u, 2u, 3u}) {
    Mesh mesh = good;
    std::mt19937 random(seed);
    int turned = 0;
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
      if (random() % 2 == 0) continue;
      std::swap(mesh.triangles(1, t), mesh.triangles(2, t));
      ++turned;
    }
    EXPECT_EQ(Orient(mesh), turned);
    EXPECT_EQ(mesh.triangles, good.triangles);
  }
}

TEST(Repair, ACavityStaysACavity) {
  Mesh inner = Tetrahedron({0.1, 0.1, 0.1}), outer = Tetrahedron();
  outer.vertices *= 9;
  inner.triangles.row(1).swap(inner.triangles.row(2));
  Mesh mesh = Together(outer, inner);
  EXPECT_EQ(Orient(mesh), 0);
  std::swap(mesh.triangles(1, 5), mesh.triangles(2, 5));
  EXPECT_EQ(Orient(mesh), 1);
  EXPECT_TRUE(AnalyseTopology(mesh).watertight());
}

}  // namespace
}  // namespace phrenic
