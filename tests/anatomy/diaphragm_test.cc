#include <gtest/gtest.h>

#include <set>

#include "server/mesh/nearest.h"
#include "server/mesh/normals.h"
#include "server/mesh/self_crossings.h"
#include "server/mesh/topology.h"
#include "server/mesh/units.h"
#include "tests/anatomy/parts.h"

namespace phrenic::anatomy {
namespace {

class DiaphragmTest : public testing::Test {
 protected:
  // Returns the highest thoracic vertex with x between `from` and `to` [m].
  Eigen::Vector3d Highest(double from, double to) const {
    Eigen::Vector3d highest(0, 0, -1);
    for (const Eigen::Vector3d x : thoracic_.colwise()) {
      if (x.x() >= from && x.x() <= to && x.z() > highest.z()) highest = x;
    }
    return highest;
  }

  std::set<int> Region(const std::string& name) const {
    const auto found = mesh_.regions.find(name);
    return found == mesh_.regions.end() ? std::set<int>() : std::set<int>(found->second.begin(), found->second.end());
  }

  const Mesh mesh_ = Diaphragm();
  const Points thoracic_ = UpperLayer(mesh_);
};

TEST_F(DiaphragmTest, DefaultHasTheVertexCountOfTheThesis) {
  EXPECT_GE(mesh_.vertices.cols(), 20000);
  EXPECT_LE(mesh_.vertices.cols(), 21000);
}

TEST_F(DiaphragmTest, TrianglesAreNearUniform) {
  EXPECT_GT(SmallestAngle(mesh_), 20);
  const Edges edges = TriangleEdges(mesh_.triangles);
  double sum = 0, longest = 0, shortest = 1;
  for (Eigen::Index e = 0; e < edges.cols(); ++e) {
    const double length = (mesh_.vertices.col(edges(0, e)) - mesh_.vertices.col(edges(1, e))).norm();
    sum += length;
    longest = std::max(longest, length);
    shortest = std::min(shortest, length);
  }
  const double mean = sum / static_cast<double>(edges.cols());
  EXPECT_NEAR(mean, 3.3 * kMillimetre, 0.4 * kMillimetre);
  EXPECT_LT(longest, 2 * mean);
  EXPECT_GT(shortest, 0.45 * mean);
}

TEST_F(DiaphragmTest, HasAdultDimensions) {
  const Eigen::Vector3d size = High(mesh_) - Low(mesh_);
  EXPECT_NEAR(size.x(), 0.243, 0.024);
  EXPECT_NEAR(size.y(), 0.179, 0.018);
  EXPECT_NEAR(size.z(), 0.207, 0.021);
  double area = 0;
  for (Eigen::Index t = 0; t < mesh_.triangles.cols(); ++t) area += Area(mesh_, t);
  EXPECT_NEAR(area / 2, 0.1085, 0.011);
}

TEST_F(DiaphragmTest, RightDomeIsAboveSaddleAndLeftDome) {
  const double right = Highest(-0.09, -0.03).z(), left = Highest(0.04, 0.09).z();
  const double saddle = Highest(-0.002, 0.002).z();
  EXPECT_GT(right - left, 0.015);
  EXPECT_LT(right - left, 0.025);
  EXPECT_GT(right - saddle, 0.010);
  EXPECT_LT(right - saddle, 0.015);
}

TEST_F(DiaphragmTest, LeftDomeIsSeparateFromTheSaddle) {
  const Eigen::Vector3d left = Highest(0.04, 0.09);
  double between = 1;  // minimum of the ridge from the midline to the left dome, in its coronal plane
  for (double x = 0; x < left.x(); x += 0.005) {
    double ridge = 0;
    for (const Eigen::Vector3d p : thoracic_.colwise()) {
      if (std::abs(p.x() - x) < 0.004 && std::abs(p.y() - left.y()) < 0.004) ridge = std::max(ridge, p.z());
    }
    between = std::min(between, ridge);
  }
  EXPECT_LT(between, left.z() - 0.003);
}

TEST_F(DiaphragmTest, RimDescendsFromFrontToSidesAndCruraReachTheLumbarSpine) {
  double front = 0, side = 1;
  for (const int i : Region("rim")) {
    const Eigen::Vector3d x = mesh_.vertices.col(i);
    if (std::abs(x.x()) < 0.01 && x.y() < -0.05) front = std::max(front, x.z());
    side = std::min(side, x.z());
  }
  EXPECT_NEAR(front - side, 0.15, 0.015);
  double right = 1, left = 1;
  for (const int i : Region("crus-right")) right = std::min(right, mesh_.vertices(2, i));
  for (const int i : Region("crus-left")) left = std::min(left, mesh_.vertices(2, i));
  EXPECT_LT(right, 0.028) << "down to L3, whose body is 28 mm high above z = 0";
  EXPECT_GT(left, 0.036) << "not below L2";
  EXPECT_LT(left, 0.063) << "down to L2";
}

TEST_F(DiaphragmTest, LayersFaceEachOtherThreeMillimetresApart) {
  const auto n = static_cast<int>(thoracic_.cols());
  const NearestSearch abdominal(LowerLayer(mesh_));
  const Points normals = VertexNormals(mesh_.vertices, mesh_.triangles);
  int acute = 0;
  for (int i = 0; i < n; ++i) {
    EXPECT_LE((thoracic_.col(i) - mesh_.vertices.col(LowerVertex(i))).norm(), 3.001 * kMillimetre);
    const Neighbour nearest = abdominal.Nearest(thoracic_.col(i));
    EXPECT_GT(nearest.distance, 2 * kMillimetre);
    EXPECT_LT(nearest.distance, 4 * kMillimetre);
    acute += normals.col(UpperVertex(i)).dot(normals.col(LowerVertex(i))) > 0 ? 1 : 0;
  }
  EXPECT_LT(acute, 0.005 * static_cast<double>(n)) << "normals agree only at sharp corners of the rim";
}

TEST_F(DiaphragmTest, HasNoSelfIntersections) { EXPECT_EQ(SelfCrossings(mesh_, 4 * kMillimetre), 0); }

TEST(Diaphragm, CoarseSheetsHaveNoSelfIntersections) {
  for (const double resolution_mm : {7.0, 12.0, 20.0}) {
    EXPECT_EQ(SelfCrossings(Diaphragm(resolution_mm), 8 * kMillimetre), 0) << resolution_mm;
  }
}

TEST_F(DiaphragmTest, TendonIsASixthToAQuarterOfTheArea) {
  const std::set<int> tendon = Region("tendon");
  double inside = 0, all = 0;
  for (Eigen::Index t = 0; t < mesh_.triangles.cols(); ++t) {
    const Eigen::Vector3i v = mesh_.triangles.col(t);
    const double area = Area(mesh_, t);
    all += area;
    for (int k = 0; k < 3; ++k) inside += tendon.contains(v[k]) ? area / 3 : 0;
  }
  EXPECT_GT(inside / all, 0.15);
  EXPECT_LT(inside / all, 0.25);
}

TEST_F(DiaphragmTest, RegionsPartitionTheSheet) {
  const std::set<int> tendon = Region("tendon"), muscle = Region("muscle"), rim = Region("rim");
  const std::set<int> right = Region("crus-right"), left = Region("crus-left");
  EXPECT_EQ(static_cast<Eigen::Index>(tendon.size() + muscle.size()), mesh_.vertices.cols());
  for (const int i : tendon) EXPECT_FALSE(muscle.contains(i));
  for (const std::set<int>& part : {rim, right, left}) {
    EXPECT_GT(part.size(), 100u);
    for (const int i : part) EXPECT_TRUE(muscle.contains(i));
  }
  for (const int i : rim) EXPECT_FALSE(right.contains(i) || left.contains(i));
  for (const int i : right) EXPECT_LT(mesh_.vertices(0, i), 0);
  for (const int i : left) EXPECT_GT(mesh_.vertices(0, i), 0);
  for (const auto& [name, region] : mesh_.regions) {
    const std::set<int> both(region.begin(), region.end());
    for (const int i : both) EXPECT_TRUE(both.contains(IsUpper(i) ? i + 1 : i - 1)) << name << " has both layers";
  }
}

// Returns the loops of edges at which the layers are joined, each with its centroid: the rim and the two openings.
std::vector<std::pair<Eigen::Vector3d, std::vector<int>>> JoinLoops(const Mesh& mesh) {
  std::map<int, int> next;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.triangles(k, t), b = mesh.triangles((k + 1) % 3, t), c = mesh.triangles((k + 2) % 3, t);
      if (IsUpper(a) && IsUpper(b) && !IsUpper(c)) next[a] = b;
    }
  }
  std::vector<std::pair<Eigen::Vector3d, std::vector<int>>> loops;
  while (!next.empty()) {
    std::vector<int> loop;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int i = next.begin()->first; next.contains(i);) {
      loop.push_back(i);
      sum += mesh.vertices.col(i);
      const int from = i;
      i = next[i];
      next.erase(from);
    }
    loops.emplace_back(sum / static_cast<double>(loop.size()), loop);
  }
  std::sort(loops.begin(), loops.end(), [](const auto& a, const auto& b) { return a.second.size() > b.second.size(); });
  return loops;
}

TEST_F(DiaphragmTest, CavalOpeningIsInTheTendonAndOesophagealInTheMuscle) {
  const auto loops = JoinLoops(mesh_);
  ASSERT_EQ(loops.size(), 3u);
  const auto& [caval, caval_loop] = loops[1].first.x() < 0 ? loops[1] : loops[2];
  const auto& [oesophageal, oesophageal_loop] = loops[1].first.x() < 0 ? loops[2] : loops[1];
  const std::set<int> tendon = Region("tendon");
  for (const int i : caval_loop) EXPECT_TRUE(tendon.contains(i));
  for (const int i : oesophageal_loop) EXPECT_FALSE(tendon.contains(i));
  EXPECT_LT(caval.x(), -0.01);
  EXPECT_GT(oesophageal.x(), 0);
  EXPECT_LT(oesophageal.x(), 0.02) << "slightly left";
  EXPECT_GT(caval.z(), oesophageal.z() + 0.025) << "T8 above T10";
  const Mesh t10 = MeshOf(Part(v1::STRUCTURE_VERTEBRA, 10));
  EXPECT_GT(oesophageal.z(), Low(t10).z());
  EXPECT_LT(oesophageal.z(), High(t10).z());
}

}  // namespace
}  // namespace phrenic::anatomy
