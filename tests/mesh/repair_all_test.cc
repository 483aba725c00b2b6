// Laws of the repairs together: a sound surface stays as it is, a repaired one too, and a dirty one comes back.
#include "server/mesh/repair_all.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "server/mesh/ellipsoid.h"
#include "server/mesh/repair.h"
#include "server/mesh/topology.h"
#include "server/mesh/triangle_tree.h"
#include "tests/mesh/solids.h"

namespace phrenic {
namespace {

using testing::HasSubstr;

constexpr double kGap = 1e-4;  // of cuts [m]

// A dome of 24 cm by 18 cm with edges of 4 mm: a sheet with a rim.
Mesh Dome() { return EllipsoidSurface({0, 0, 0}, {0.12, 0.09, 0.07}, 40, true); }

RepairOptions AllRepairs() {
  RepairOptions options;
  options.repairs = {"all"};
  options.hole = 0.015;
  return options;
}

double Farthest(const Mesh& from, const Mesh& to) {
  const TriangleTree tree(to.vertices, to.triangles);
  TriangleTree::Boxes boxes;
  tree.Fit(to.vertices, boxes);
  double farthest = 0;
  for (Eigen::Index i = 0; i < from.vertices.cols(); ++i) {
    farthest = std::max(farthest, tree.Nearest(to.vertices, boxes, from.vertices.col(i), 1).squared);
  }
  return std::sqrt(farthest);
}

// Removes the triangles around a vertex.
void Pierce(int vertex, Mesh& mesh) {
  std::vector<int> kept;
  for (int t = 0; t < static_cast<int>(mesh.triangles.cols()); ++t) {
    if ((mesh.triangles.col(t).array() != vertex).all()) kept.push_back(t);
  }
  mesh.triangles = Triangles(mesh.triangles(Eigen::all, kept));
}

// Cuts a mesh into sectors around the z axis, each of which gets vertices of its own, off by up to kGap / 2.
Mesh Cut(const Mesh& mesh, int sectors, std::mt19937& random) {
  std::uniform_real_distribution<double> off(-kGap / 4, kGap / 4);
  Mesh cut = {mesh.vertices(Eigen::all, std::vector<int>()), Triangles(3, 0), {}, {}, {}};
  for (int sector = 0; sector < sectors; ++sector) {
    Mesh piece = mesh;
    std::vector<int> kept;
    for (int t = 0; t < static_cast<int>(mesh.triangles.cols()); ++t) {
      const Eigen::Vector3d middle = mesh.vertices(Eigen::all, mesh.triangles.col(t)).rowwise().mean();
      const double turn = std::atan2(middle.y(), middle.x()) / (2 * M_PI) + 0.5;
      if (static_cast<int>(turn * sectors) == sector) kept.push_back(t);
    }
    piece.triangles = Triangles(mesh.triangles(Eigen::all, kept));
    piece.vertices.colwise() += Eigen::Vector3d(off(random), off(random), off(random));
    cut = Together(cut, piece);
  }
  return cut;
}

// The dome in twelve components: six sectors, six crumbs; with holes, a pinch, doubled vertices and turned triangles.
Mesh DirtyDome(unsigned seed) {
  std::mt19937 random(seed);
  Mesh mesh = Dome();
  for (const int vertex : {700, 1500, 2100}) Pierce(vertex, mesh);
  mesh = Cut(mesh, 6, random);
  Mesh crumb = Tetrahedron();
  crumb.vertices *= 1e-3;
  for (int c = 0; c < 6; ++c) {
    Mesh placed = crumb;
    placed.vertices.colwise() += Eigen::Vector3d(0.02 * c - 0.05, 0.01, 0.03);
    mesh = Together(mesh, placed);
  }
  const auto pinched = mesh.triangles(0, 1200), first = static_cast<int>(mesh.vertices.cols());
  Mesh bead = crumb;
  bead.vertices.colwise() += Eigen::Vector3d(mesh.vertices.col(pinched));
  mesh = Together(mesh, bead);
  for (int& corner : mesh.triangles.reshaped()) corner = corner == first ? pinched : corner;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    if (random() % 5 == 0) std::swap(mesh.triangles(1, t), mesh.triangles(2, t));
  }
  return mesh;
}

void ExpectDome(const Mesh& mesh, const RepairReport& report) {
  EXPECT_EQ(report.parts, 1);
  ASSERT_EQ(report.open.size(), 1U);
  EXPECT_TRUE(report.open[0].rim);
  const SurfaceTopology topology = AnalyseTopology(mesh);
  EXPECT_EQ(topology.misoriented_edges, 0);
  EXPECT_EQ(topology.non_manifold_edges, 0);
  EXPECT_EQ(topology.degenerate_triangles, 0);
  EXPECT_EQ(topology.euler_characteristic(), 1) << "a disc";
  EXPECT_EQ(PinchedVertices(mesh.triangles).size(), 0U);
  EXPECT_LT(Farthest(mesh, Dome()), kGap);
  EXPECT_LT(Farthest(Dome(), mesh), 6e-4) << "over a hole of 11 mm in a dome of 60 mm radius, and a cut";
}

TEST(RepairAll, ASoundSurfaceIsUnchangedBitForBit) {
  Mesh far = Torus(0.02, 0.005, 16, 8);
  far.vertices.row(0).array() += 0.2;
  for (const Mesh& sound : {Dome(), Torus(0.2, 0.05, 16, 8), Together(Dome(), far),
                            EllipsoidSurface({0, 0, 0}, {0.05, 0.05, 0.05}, 5, false)}) {
    Mesh mesh = sound;
    const RepairReport report = RepairAll(AllRepairs(), mesh);
    EXPECT_THAT(report.changes, testing::Each(0));
    EXPECT_EQ(mesh.vertices, sound.vertices);
    EXPECT_EQ(mesh.triangles, sound.triangles);
    EXPECT_EQ(mesh.regions, sound.regions);
  }
}

TEST(RepairAll, ADirtyDomeOfTwelveComponentsComesBack) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    Mesh mesh = DirtyDome(seed);
    ASSERT_EQ(Components(mesh).size(), 12U);
    ASSERT_GT(AnalyseTopology(mesh).boundary_edges, 400);
    ASSERT_GT(AnalyseTopology(mesh).misoriented_edges, 100);
    const RepairReport report = RepairAll(AllRepairs(), mesh);
    ExpectDome(mesh, report);
    std::printf("dirty dome %u: %.3f mm and %.3f mm from the sound one\n", seed, 1e3 * Farthest(mesh, Dome()),
                1e3 * Farthest(Dome(), mesh));
  }
}

TEST(RepairAll, RepairingARepairedSurfaceChangesNothing) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    for (const double hole : {0.015, 0.0}) {
      RepairOptions options = AllRepairs();
      options.hole = hole;
      Mesh mesh = DirtyDome(seed);
      RepairAll(options, mesh);
      const Mesh once = mesh;
      EXPECT_THAT(RepairAll(options, mesh).changes, testing::Each(0));
      EXPECT_EQ(mesh.vertices, once.vertices);
      EXPECT_EQ(mesh.triangles, once.triangles);
    }
  }
}

// Each repair is the cause: without it, its defect stays.
TEST(RepairAll, WithoutARepairItsDefectStays) {
  const auto without = [](std::string_view left_out, Mesh& mesh) {
    RepairOptions options = AllRepairs();
    options.repairs.clear();
    for (const std::string_view repair : kRepairs) {
      if (repair != left_out) options.repairs.emplace_back(repair);
    }
    mesh = DirtyDome(1);
    return RepairAll(options, mesh);
  };
  Mesh mesh;
  EXPECT_GT(without("cuts", mesh).parts, 1);
  EXPECT_GT(without("crumbs", mesh).parts, 6);
  EXPECT_EQ(without("holes", mesh).open.size(), 4U);
  without("pinches", mesh);
  EXPECT_EQ(PinchedVertices(mesh.triangles).size(), 1U);
  without("orient", mesh);
  EXPECT_GT(AnalyseTopology(mesh).misoriented_edges, 100);
}

TEST(RepairAll, HolesOverTheSizeStayAndAreNamed) {
  Mesh mesh = Dome();
  Pierce(700, mesh);
  RepairOptions options = AllRepairs();
  options.hole = 0.002;
  RepairReport report = RepairAll(options, mesh);
  ASSERT_EQ(report.open.size(), 2U);
  const Hole& hole = report.open[0].rim ? report.open[1] : report.open[0];
  EXPECT_FALSE(hole.rim);
  EXPECT_EQ(hole.vertices.size(), 6U);
  EXPECT_LT((hole.centre - Dome().vertices.col(700)).norm(), 1e-3);
  EXPECT_THAT(Describe(hole, 1e3), HasSubstr("a hole of 6 edges"));
  options.hole = 0.015;
  report = RepairAll(options, mesh);
  EXPECT_EQ(report.open.size(), 1U);
  EXPECT_THAT(Describe(report.open[0], 1e3), HasSubstr("a rim of"));
}

// A closed surface with each of its triangles missing in turn is closed again by that triangle.
TEST(RepairAll, AMissingTriangleComesBack) {
  const Mesh whole = EllipsoidSurface({0, 0, 0}, {0.05, 0.04, 0.03}, 3, false);
  for (Eigen::Index gone = 0; gone < whole.triangles.cols(); ++gone) {
    Mesh mesh = whole;
    mesh.triangles.col(gone) = mesh.triangles.rightCols(1);
    mesh.triangles.conservativeResize(3, whole.triangles.cols() - 1);
    RepairOptions options = AllRepairs();
    options.hole = 0.1;
    RepairAll(options, mesh);
    EXPECT_TRUE(AnalyseTopology(mesh).watertight());
    EXPECT_NEAR(SignedVolume(mesh.vertices, mesh.triangles), SignedVolume(whole.vertices, whole.triangles), 1e-15);
  }
}

// Two tetrahedra that share a vertex, or the edge from 0 to 1.
Mesh Touching(int shared) {
  Mesh turned = Tetrahedron();
  turned.vertices.bottomRows(2) *= -1;  // a half turn about the edge
  if (shared == 1) {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(2, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    turned.vertices = Points(turn * turned.vertices);
  }
  Mesh mesh = Together(Tetrahedron(), turned);
  for (int& corner : mesh.triangles.reshaped()) corner = corner >= 4 && corner < 4 + shared ? corner - 4 : corner;
  DropSlivers(0, mesh);
  return mesh;
}

TEST(Repair, BodiesThatTouchInAPointOrAnEdgeArePartedWithoutCoincidentVertices) {
  constexpr double kApart = 2e-6;
  for (const int shared : {1, 2}) {
    Mesh mesh = Touching(shared);
    EXPECT_EQ(Components(mesh).size(), 1U);
    mesh.regions["edge"] = {0};
    EXPECT_EQ(SplitPinches(kApart, mesh), shared);
    EXPECT_EQ(Components(mesh).size(), 2U);
    EXPECT_TRUE(AnalyseTopology(mesh).watertight());
    EXPECT_EQ(mesh.vertices.cols(), 8);
    EXPECT_EQ(mesh.regions["edge"].size(), 2U) << "the copies are in the region too";
    EXPECT_NEAR(SignedVolume(mesh.vertices, mesh.triangles), 1.0 / 3, 1e-5);
    EXPECT_EQ(Weld(kApart / 2, mesh), 0);
    EXPECT_EQ(SplitPinches(kApart, mesh), 0);
  }
}

TEST(Repair, ACutWiderThanTheGapStays) {
  std::mt19937 random(1);
  Mesh mesh = Cut(Dome(), 2, random);
  EXPECT_EQ(JoinCuts(1e-6, mesh), 0);
  EXPECT_GT(JoinCuts(kGap, mesh), 20);
  EXPECT_EQ(Components(mesh).size(), 1U);
}

TEST(Repair, AnObjectThatIsSmallByItselfIsNoCrumb) {
  Mesh mesh = Together(Tetrahedron(), Tetrahedron({2, 0, 0}));
  mesh.vertices *= 1e-4;
  EXPECT_EQ(DropCrumbs(5e-3, mesh), 0) << "metres read as millimetres, perhaps";
  Mesh large = Dome();
  EXPECT_EQ(DropCrumbs(5e-3, large = Together(large, mesh)), 2);
  EXPECT_EQ(large.triangles, Dome().triangles);
}

}  // namespace
}  // namespace phrenic
