// Organs lie on their side of the diaphragm, pass through its openings, and are as large as an adult's.
#include <gtest/gtest.h>

#include "server/mesh/nearest.h"
#include "server/mesh/self_crossings.h"
#include "server/mesh/topology.h"
#include "server/mesh/units.h"
#include "tests/anatomy/parts.h"

namespace phrenic::anatomy {
namespace {

// The middle surface of the sheet, by the double layer that is seen, and its normals towards the thorax.
class MiddleOfSheet {
 public:
  MiddleOfSheet() : upper_(UpperLayer(Diaphragm())), lower_(LowerLayer(Diaphragm())), search_((upper_ + lower_) / 2) {}

  struct Foot {
    double distance;  // [m]
    double above;     // along the normal, positive towards the thorax [m]
  };
  Foot Of(const Eigen::Vector3d& point) const {
    const Neighbour at = search_.Nearest(point);
    const Eigen::Vector3d normal = (upper_.col(at.vertex) - lower_.col(at.vertex)).normalized();
    return {at.distance, normal.dot(point - (upper_.col(at.vertex) + lower_.col(at.vertex)) / 2)};
  }

 private:
  Points upper_, lower_;
  NearestSearch search_;
};

const MiddleOfSheet& Sheet() {
  static const MiddleOfSheet sheet;
  return sheet;
}

// Returns the smallest distance to the middle surface [m].
double Clearance(const v1::Anatomy& part) {
  double smallest = 1;
  for (const auto& x : MeshOf(part).vertices.colwise()) smallest = std::min(smallest, Sheet().Of(x).distance);
  return smallest;
}

double VolumeOf(const v1::Anatomy& part) { return SignedVolume(MeshOf(part).vertices, MeshOf(part).triangles); }

TEST(Organs, AbdominalOnesAreBelowTheDiaphragm) {
  for (const v1::Anatomy& part : AbdominalOrgans()) {
    double closest = 1;
    for (const auto& x : MeshOf(part).vertices.colwise()) {
      const auto [distance, above] = Sheet().Of(x);
      closest = std::min(closest, distance);
      if (distance > 15 * kMillimetre) continue;
      EXPECT_LT(above, -2.5 * kMillimetre) << part.ShortDebugString();
    }
    EXPECT_LT(closest, 6 * kMillimetre) << "lies under the dome: " << part.ShortDebugString();
  }
}

TEST(Organs, HeartRestsOnTheTendon) {
  double closest = 1;
  for (const auto& x : MeshOf(Part(v1::STRUCTURE_HEART)).vertices.colwise()) {
    const auto [distance, above] = Sheet().Of(x);
    closest = std::min(closest, distance);
    if (distance > 15 * kMillimetre) continue;
    EXPECT_GT(above, 2.5 * kMillimetre);
  }
  EXPECT_LT(closest, 5 * kMillimetre);
}

TEST(Organs, CavalVeinAndGulletPassThroughTheOpeningsWithoutTouching) {
  for (const v1::Anatomy& part : {Part(v1::STRUCTURE_VENA_CAVA, 2), Part(v1::STRUCTURE_OESOPHAGUS)}) {
    EXPECT_GT(Clearance(part), kBorderGap / 2 * kMillimetre) << part.ShortDebugString();
    const Mesh& tube = MeshOf(part);
    EXPECT_GT(High(tube).z(), 0.235) << "starts above the domes";
    EXPECT_LT(Low(tube).z(), 0.165) << "ends below them";
  }
}

// Returns the number of edges of either surface that pierce the other.
int Crossings(const v1::Anatomy& part, const v1::Anatomy& other) {
  const Mesh &a = MeshOf(part), &b = MeshOf(other);
  Mesh both = a;
  both.vertices.conservativeResize(3, a.vertices.cols() + b.vertices.cols());
  both.vertices.rightCols(b.vertices.cols()) = b.vertices;
  both.triangles.conservativeResize(3, a.triangles.cols() + b.triangles.cols());
  both.triangles.rightCols(b.triangles.cols()) = b.triangles.array() + static_cast<int>(a.vertices.cols());
  constexpr double kCell = 5 * kMillimetre;
  return SelfCrossings(both, kCell) - SelfCrossings(a, kCell) - SelfCrossings(b, kCell);
}

TEST(Organs, TheAortaTouchesNothingButTheHeartFromWhichItRises) {
  const v1::Anatomy aorta = Part(v1::STRUCTURE_AORTA);
  std::vector<v1::Anatomy> others = Bones();
  others.push_back(Part(v1::STRUCTURE_DIAPHRAGM));
  for (const auto& more : {AbdominalOrgans(), Kidneys()}) others.insert(others.end(), more.begin(), more.end());
  for (const v1::Anatomy& organ : Mediastinum()) {
    if (organ.structure() != v1::STRUCTURE_AORTA && organ.structure() != v1::STRUCTURE_HEART) others.push_back(organ);
  }
  for (const v1::Anatomy& other : others) EXPECT_EQ(Crossings(aorta, other), 0) << other.ShortDebugString();
  EXPECT_GT(Crossings(aorta, Part(v1::STRUCTURE_HEART)), 0);
}

TEST(Organs, TheAortaDescendsLeftOfTheMidlineAndPassesBehindTheSheet) {
  const double arcuate = 0.120;  // z of the median arcuate ligament's lower border, at T12/L1 [m]
  EXPECT_GT(arcuate, Low(MeshOf(Part(v1::STRUCTURE_VERTEBRA, 13))).z());
  EXPECT_LT(arcuate, High(MeshOf(Part(v1::STRUCTURE_VERTEBRA, 12))).z());
  int thoracic = 0, behind = 0, in_front = 0;
  for (const auto& x : MeshOf(Part(v1::STRUCTURE_AORTA)).vertices.colwise()) {
    if (x.y() > 0 && x.z() > 0.23 && x.z() < 0.29) {
      EXPECT_GT(x.x(), 0);
      ++thoracic;
    }
    const auto [distance, above] = Sheet().Of(x);
    if (distance > 15 * kMillimetre || x.z() > 0.185) continue;
    if (x.z() > arcuate) {
      EXPECT_GT(above, 0) << "in front of the sheet: " << x.transpose();
      ++behind;
    }
    if (x.z() < 0.1 && above < 0) ++in_front;
  }
  EXPECT_GT(thoracic, 20);
  EXPECT_GT(behind, 50);
  EXPECT_GT(in_front, 20) << "comes forward between the crura";
}

TEST(Organs, GulletEndsInTheStomach) {
  const Mesh& gullet = MeshOf(Part(v1::STRUCTURE_OESOPHAGUS));
  Eigen::Index lowest = 0;
  gullet.vertices.row(2).minCoeff(&lowest);
  const NearestSearch stomach(MeshOf(Part(v1::STRUCTURE_STOMACH)).vertices);
  EXPECT_LT(stomach.Nearest(gullet.vertices.col(lowest)).distance, 12 * kMillimetre);
}

TEST(Organs, HaveAnAdultsVolume) {
  const auto expect = [](v1::Structure structure, double least, double most) {
    EXPECT_GT(1e6 * VolumeOf(Part(structure)), least) << v1::Structure_Name(structure);
    EXPECT_LT(1e6 * VolumeOf(Part(structure)), most) << v1::Structure_Name(structure);
  };
  expect(v1::STRUCTURE_HEART, 350, 800);  // [ml]
  expect(v1::STRUCTURE_LIVER, 1000, 1900);
  expect(v1::STRUCTURE_STOMACH, 200, 700);
  expect(v1::STRUCTURE_SPLEEN, 90, 300);
}

TEST(Organs, DiscsFillTheSpaceBetweenTwoVertebrae) {
  for (int i = 1; i <= 14; ++i) {
    const Mesh& disc = MeshOf(Part(v1::STRUCTURE_DISC, i));
    const NearestSearch search(disc.vertices);
    for (const int neighbour : {i, i + 1}) {
      double nearest = 1;
      for (const auto& x : MeshOf(Part(v1::STRUCTURE_VERTEBRA, neighbour)).vertices.colwise()) {
        nearest = std::min(nearest, search.Nearest(x).distance);
      }
      EXPECT_LT(nearest, 2 * kMillimetre) << i;
    }
  }
}

}  // namespace
}  // namespace phrenic::anatomy
