// The diaphragm's middle surface, for mechanics.
#include <gtest/gtest.h>

#include <set>

#include "server/mesh/normals.h"
#include "server/mesh/self_crossings.h"
#include "server/mesh/topology.h"
#include "server/mesh/triangle_tree.h"
#include "server/mesh/units.h"
#include "tests/anatomy/parts.h"

namespace phrenic::anatomy {
namespace {

const Mesh& Middle(double resolution_mm = 0) {
  return MeshOf(Part(v1::STRUCTURE_DIAPHRAGM), resolution_mm, v1::SHEET_MIDDLE);
}

std::set<int> Region(const Mesh& mesh, const std::string& name) {
  const auto found = mesh.regions.find(name);
  return found == mesh.regions.end() ? std::set<int>() : std::set<int>(found->second.begin(), found->second.end());
}

bool Within(const std::set<int>& region, const Eigen::Vector3i& triangle) {
  return region.contains(triangle[0]) && region.contains(triangle[1]) && region.contains(triangle[2]);
}

double TotalArea(const Mesh& mesh) { return VertexAreas(mesh.vertices, mesh.triangles).sum(); }

// At the default resolution, at those at which mechanics was proven, and at the ends.
class MiddleSheetTest : public testing::TestWithParam<double> {
 protected:
  const Mesh& mesh_ = Middle(GetParam());
};

INSTANTIATE_TEST_SUITE_P(Resolutions, MiddleSheetTest, testing::Values(0, 3.16, 5, 6.5, 12, 20));

TEST_P(MiddleSheetTest, IsADiscWhoseOnlyBorderIsTheRim) {
  ASSERT_TRUE(Validate(mesh_).ok());
  const SurfaceTopology topology = AnalyseTopology(mesh_);
  EXPECT_EQ(topology.vertices, mesh_.vertices.cols()) << "every vertex is used";
  EXPECT_EQ(topology.components, 1);
  EXPECT_EQ(topology.non_manifold_edges, 0);
  EXPECT_EQ(topology.misoriented_edges, 0);
  EXPECT_EQ(topology.degenerate_triangles, 0);
  EXPECT_EQ(topology.euler_characteristic(), 1) << "a disc: genus 0, one border";
  EXPECT_TRUE(PinchedVertices(mesh_.triangles).empty());
  EXPECT_EQ(BoundaryVertices(mesh_.triangles), mesh_.regions.at("rim"));
  EXPECT_EQ(static_cast<size_t>(topology.boundary_edges), mesh_.regions.at("rim").size()) << "one loop";
}

// The strip across the hiatus is 14 mm wide at every resolution, so that its triangles are slender in fine meshes.
TEST_P(MiddleSheetTest, HasNeitherSliversNorIntersections) {
  EXPECT_GT(SmallestAngle(mesh_), 10);
  Mesh outside = mesh_;
  const std::set<int> hiatus = Region(mesh_, "aortic-hiatus");
  Eigen::Index kept = 0;
  for (Eigen::Index t = 0; t < mesh_.triangles.cols(); ++t) {
    if (!Within(hiatus, mesh_.triangles.col(t))) outside.triangles.col(kept++) = mesh_.triangles.col(t);
  }
  outside.triangles.conservativeResize(3, kept);
  EXPECT_GT(SmallestAngle(outside), 12);
  EXPECT_EQ(SelfCrossings(mesh_, 8 * kMillimetre), 0);
}

TEST_P(MiddleSheetTest, FacesTheThorax) {
  // The thoracic layer of the double layer, where it faces outwards.
  const Mesh& layers = Diaphragm(GetParam() == 0 ? 5 : GetParam());
  const Points normals = VertexNormals(mesh_.vertices, mesh_.triangles);
  const Points upper = UpperLayer(layers), lower = LowerLayer(layers);
  const TriangleTree tree(mesh_.vertices, mesh_.triangles);
  TriangleTree::Boxes boxes;
  tree.Fit(mesh_.vertices, boxes);
  int behind = 0;
  for (Eigen::Index i = 0; i < upper.cols(); ++i) {
    const SurfacePoint at = tree.Nearest(mesh_.vertices, boxes, (upper.col(i) + lower.col(i)) / 2, 1);
    const Eigen::Vector3d normal = normals(Eigen::all, tree.triangle(at.triangle)) * at.weights;
    behind += normal.dot(upper.col(i) - lower.col(i)) > 0 ? 0 : 1;
  }
  EXPECT_EQ(behind, 0);
}

TEST_P(MiddleSheetTest, LiesMidwayBetweenTheLayersOfTheSameResolution) {
  const double resolution = GetParam() == 0 ? 5 : GetParam();
  const Mesh& layers = Diaphragm(resolution);
  const TriangleTree tree(mesh_.vertices, mesh_.triangles);
  TriangleTree::Boxes boxes;
  tree.Fit(mesh_.vertices, boxes);
  const Points middle = (UpperLayer(layers) + LowerLayer(layers)) / 2;
  EXPECT_EQ(middle.cols() + 2, mesh_.vertices.cols()) << "and the two hubs";
  for (const Eigen::Vector3d x : middle.colwise()) {
    EXPECT_LT(std::sqrt(tree.Nearest(mesh_.vertices, boxes, x, 1).squared), 1e-9);
  }
}

TEST_P(MiddleSheetTest, RegionsDivideIt) {
  const std::set<int> tendon = Region(mesh_, "tendon"), muscle = Region(mesh_, "muscle");
  EXPECT_EQ(static_cast<Eigen::Index>(tendon.size() + muscle.size()), mesh_.vertices.cols());
  for (const int i : tendon) EXPECT_FALSE(muscle.contains(i));
  for (const char* name : {"rim", "insertion", "crus-right", "crus-left"}) {
    EXPECT_GT(Region(mesh_, name).size(), 8u) << name;
    for (const int i : Region(mesh_, name)) EXPECT_TRUE(muscle.contains(i)) << name;
  }
  for (const int i : Region(mesh_, "crus-right")) EXPECT_LT(mesh_.vertices(0, i), 0);
  for (const int i : Region(mesh_, "crus-left")) EXPECT_GT(mesh_.vertices(0, i), 0);
}

TEST_P(MiddleSheetTest, TendonIsASixthToAQuarterOfTheArea) {
  const std::set<int> tendon = Region(mesh_, "tendon");
  double inside = 0;
  for (Eigen::Index t = 0; t < mesh_.triangles.cols(); ++t) {
    for (int k = 0; k < 3; ++k) inside += tendon.contains(mesh_.triangles(k, t)) ? Area(mesh_, t) / 3 : 0;
  }
  EXPECT_GT(inside / TotalArea(mesh_), 0.15);
  EXPECT_LT(inside / TotalArea(mesh_), 0.25);
}

TEST_P(MiddleSheetTest, OpeningsAreClosedByFansAroundTheirHubs) {
  const std::set<int> hubs = Region(mesh_, "hubs");
  EXPECT_EQ(hubs.size(), 2u);
  for (const auto& [name, tissue] :
       {std::pair("caval-opening", "tendon"), std::pair("oesophageal-opening", "muscle")}) {
    const std::set<int> opening = Region(mesh_, name), around = Region(mesh_, tissue);
    EXPECT_GE(opening.size(), 9u) << name;
    for (const int i : opening) EXPECT_TRUE(around.contains(i)) << name;
    size_t fan = 0;
    for (Eigen::Index t = 0; t < mesh_.triangles.cols(); ++t) {
      if (!Within(opening, mesh_.triangles.col(t))) continue;
      ++fan;
      const Eigen::Vector3i v = mesh_.triangles.col(t);
      EXPECT_EQ(hubs.count(v[0]) + hubs.count(v[1]) + hubs.count(v[2]), 1u) << name;
    }
    EXPECT_EQ(fan, opening.size() - 1) << name;
  }
}

TEST_P(MiddleSheetTest, TheAortaFillsTheHiatusBetweenTheCrura) {
  const std::set<int> hiatus = Region(mesh_, "aortic-hiatus"), rim = Region(mesh_, "rim");
  size_t strip = 0, on_rim = 0;
  for (const int i : hiatus) {
    const Eigen::Vector3d x = mesh_.vertices.col(i);
    EXPECT_LT(std::abs(x.x()), 0.015);
    EXPECT_GT(x.y(), -0.03) << "at the back";
    on_rim += rim.contains(i) ? 1 : 0;
  }
  EXPECT_EQ(on_rim, 2u) << "one vertex of each crus";
  for (Eigen::Index t = 0; t < mesh_.triangles.cols(); ++t) strip += Within(hiatus, mesh_.triangles.col(t)) ? 1 : 0;
  EXPECT_EQ(strip, hiatus.size() - 2) << "the strip has no vertex of its own, and no other triangle lies in the region";
}

TEST_P(MiddleSheetTest, InsertionIsTheRimAndHoldsTheCrura) {
  const std::set<int> insertion = Region(mesh_, "insertion"), rim = Region(mesh_, "rim");
  for (const int i : rim) EXPECT_TRUE(insertion.contains(i));
  for (const char* crus : {"crus-right", "crus-left"}) {
    for (const int i : Region(mesh_, crus)) {
      EXPECT_TRUE(mesh_.vertices(2, i) > 0.075 || insertion.contains(i)) << crus;
    }
  }
  for (const int i : insertion) {
    EXPECT_TRUE(rim.contains(i) || mesh_.vertices(2, i) < 0.075) << "only the crura are fixed inside the rim";
  }
}

TEST_P(MiddleSheetTest, NeighboursAreCloseInMemory) {
  const Edges edges = TriangleEdges(mesh_.triangles);
  const double vertices = static_cast<double>(mesh_.vertices.cols());
  const int furthest = (edges.row(1) - edges.row(0)).maxCoeff();
  EXPECT_LT(furthest, 6 * std::sqrt(vertices));
  for (Eigen::Index t = 1; t < mesh_.triangles.cols(); ++t) {
    EXPECT_GE(mesh_.triangles.col(t).minCoeff(), mesh_.triangles.col(t - 1).minCoeff());
  }
}

TEST(MiddleSheet, DefaultHasAboutFourThousandVertices) {
  EXPECT_GT(Middle().vertices.cols(), 3700);
  EXPECT_LT(Middle().vertices.cols(), 4300);
}

TEST(MiddleSheet, AreaHardlyDependsOnTheResolution) {
  const double fine = TotalArea(Middle(3.16));
  EXPECT_NEAR(fine, 0.1085, 0.011);
  EXPECT_NEAR(TotalArea(Middle(5)), fine, 0.01 * fine);
  EXPECT_NEAR(TotalArea(Middle(6.5)), fine, 0.015 * fine);
}

TEST(MiddleSheet, OnlyTheDiaphragmIsASheet) {
  const auto made = Generate(Part(v1::STRUCTURE_MANUBRIUM), 0, v1::SHEET_MIDDLE);
  ASSERT_EQ(made.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_NE(std::string(made.status().message()).find("generated.sheet"), std::string::npos);
  EXPECT_EQ(MeshOf(Part(v1::STRUCTURE_DIAPHRAGM), 9, v1::SHEET_DOUBLE).vertices, Diaphragm(9).vertices);
}

}  // namespace
}  // namespace phrenic::anatomy
