// The inner face of the rib cage fits between the diaphragm and the bones.
#include <gtest/gtest.h>

#include "server/mesh/topology.h"
#include "server/mesh/triangle_tree.h"
#include "server/mesh/units.h"
#include "tests/anatomy/parts.h"

namespace phrenic::anatomy {
namespace {

const Mesh& Cage(double resolution_mm = 0) { return MeshOf(Part(v1::STRUCTURE_INNER_CAGE), resolution_mm); }

// Returns how far each point is outside the cage [m]; negative inside. Points nearest to its open ends, and those more
// than 5 mm away, count as 0.
std::vector<double> Outside(const Mesh& cage, const Points& points) {
  const TriangleTree tree(cage.vertices, cage.triangles);
  TriangleTree::Boxes boxes;
  tree.Fit(cage.vertices, boxes);
  std::vector<double> outside;
  for (const Eigen::Vector3d x : points.colwise()) {
    const SurfacePoint at = tree.Nearest(cage.vertices, boxes, x, 5 * kMillimetre);
    const double distance = std::sqrt(at.squared);
    outside.push_back(at.triangle < 0 || at.on_boundary ? 0 : at.facing > 0 ? -distance : distance);
  }
  return outside;
}

TEST(InnerCage, IsAGridOfAzimuthAndHeight) {
  const Mesh& cage = Cage();
  const auto columns = static_cast<int>(cage.regions.at("bottom").size());
  const int rows = static_cast<int>(cage.vertices.cols()) / columns;
  EXPECT_EQ(columns, 144);
  EXPECT_EQ(rows, 100);
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const Eigen::Vector3d x = cage.vertices.col(j * columns + i);
      EXPECT_NEAR(x.z(), 0.396 * j / (rows - 1), 1e-12) << "rows are heights";
      const Eigen::Vector3d mirrored = cage.vertices.col(j * columns + (columns - i) % columns);
      EXPECT_NEAR(mirrored.x(), -x.x(), 1e-12);
      EXPECT_NEAR(mirrored.y(), x.y(), 1e-12);
    }
    EXPECT_LT(cage.vertices(1, j * columns), cage.vertices(1, j * columns + columns / 2)) << "column 0 is the front";
    EXPECT_GT(cage.vertices(0, j * columns + columns / 4), 0) << "then the left";
  }
}

TEST(InnerCage, IsATubeThatFacesOutwardsAtAnyResolution) {
  for (const double resolution_mm : {0.0, 1.5, 7.0, 20.0, 50.0}) {
    const Mesh& cage = Cage(resolution_mm);
    ASSERT_TRUE(Validate(cage).ok());
    const SurfaceTopology topology = AnalyseTopology(cage);
    EXPECT_EQ(topology.euler_characteristic(), 0) << "an annulus";
    EXPECT_EQ(topology.components, 1);
    EXPECT_EQ(topology.misoriented_edges + topology.non_manifold_edges + topology.degenerate_triangles, 0);
    const size_t columns = cage.regions.at("bottom").size();
    EXPECT_EQ(cage.regions.at("top").size(), columns);
    EXPECT_EQ(static_cast<size_t>(topology.boundary_edges), 2 * columns);
    double volume = 0;  // div (x, y, 0) = 2, and the open ends are horizontal
    for (Eigen::Index t = 0; t < cage.triangles.cols(); ++t) {
      const Eigen::Vector3d area =
          (Corner(cage, t, 1) - Corner(cage, t, 0)).cross(Corner(cage, t, 2) - Corner(cage, t, 0));
      Eigen::Vector3d middle = (Corner(cage, t, 0) + Corner(cage, t, 1) + Corner(cage, t, 2)) / 3;
      middle.z() = 0;
      volume += middle.dot(area) / 4;
    }
    EXPECT_NEAR(volume, 0.0092, 0.0007) << "faces outwards, " << resolution_mm << " mm";
  }
}

TEST(InnerCage, HoldsTheMiddleSheet) {
  for (const double resolution_mm : {3.16, 0.0, 6.5}) {
    const Mesh& middle = MeshOf(Part(v1::STRUCTURE_DIAPHRAGM), resolution_mm, v1::SHEET_MIDDLE);
    const std::vector<double> outside = Outside(Cage(), middle.vertices);
    EXPECT_LE(*std::max_element(outside.begin(), outside.end()), 0) << resolution_mm;
    const auto apposed =
        std::count_if(outside.begin(), outside.end(), [](double d) { return d < 0 && d > -0.3 * kMillimetre; });
    EXPECT_GT(apposed, middle.vertices.cols() / 3) << "the zone of apposition lies on it";
  }
}

// So that a wall can be a radius by azimuth about the axis x = 0, y = -60 mm, as high as domes rise.
TEST(InnerCage, IsSeenWholeFromAnAxis) {
  const Mesh& cage = Cage();
  const auto columns = static_cast<Eigen::Index>(cage.regions.at("bottom").size());
  for (Eigen::Index v = 0; v < cage.vertices.cols(); ++v) {
    const Eigen::Index row = v / columns, next = row * columns + (v + 1) % columns;
    const Eigen::Vector3d axis(0, -0.06, cage.vertices(2, v));
    const Eigen::Vector3d a = cage.vertices.col(v) - axis, b = cage.vertices.col(next) - axis;
    EXPECT_TRUE(axis.z() > 0.264 || a.cross(b).z() > 0) << axis.z();
  }
}

TEST(InnerCage, LiesInsideTheBones) {
  for (const v1::Anatomy& part : Bones()) {
    for (const double outside : Outside(Cage(), MeshOf(part).vertices))
      EXPECT_GE(outside, 0) << part.ShortDebugString();
  }
}

}  // namespace
}  // namespace phrenic::anatomy
