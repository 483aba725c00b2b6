// Shoulder girdle, kidneys, lobes and fissures, and the facet joints of the spine fit their neighbours.
#include <gtest/gtest.h>

#include <algorithm>

#include "server/mesh/nearest.h"
#include "server/mesh/tetrahedra.h"
#include "server/mesh/topology.h"
#include "server/mesh/triangle_tree.h"
#include "server/mesh/units.h"
#include "tests/anatomy/parts.h"

namespace phrenic::anatomy {
namespace {

// A closed surface for signed distances.
class ClosedPart {
 public:
  explicit ClosedPart(const v1::Anatomy& part) : mesh_(MeshOf(part)), tree_(mesh_.vertices, mesh_.triangles) {
    tree_.Fit(mesh_.vertices, boxes_);
  }

  // Returns the smallest distance of the points from the surface, of those within 12 mm [mm]; negative if a point is
  // inside.
  double SmallestGap(const Points& points) const {
    constexpr double kWithin = 12;
    double smallest = kWithin;
    for (const auto& x : points.colwise()) {
      const SurfacePoint at = tree_.Nearest(mesh_.vertices, boxes_, x, kWithin * kMillimetre);
      if (at.triangle < 0) continue;
      const bool inside = at.facing > 0 && WindingNumber(mesh_, x) > 0.5;  // the faces at a sharp tip face both ways
      smallest = std::min(smallest, (inside ? -1 : 1) * std::sqrt(at.squared) / kMillimetre);
    }
    return smallest;
  }

 private:
  const Mesh& mesh_;
  TriangleTree tree_;
  TriangleTree::Boxes boxes_;
};

double SmallestGap(const v1::Anatomy& of, const v1::Anatomy& from) {
  return ClosedPart(from).SmallestGap(MeshOf(of).vertices);
}

double NearestDistance(const v1::Anatomy& a, const v1::Anatomy& b) {
  const NearestSearch search(MeshOf(b).vertices);
  double nearest = 1;
  for (const auto& x : MeshOf(a).vertices.colwise()) nearest = std::min(nearest, search.Nearest(x).distance);
  return nearest / kMillimetre;
}

double Millilitres(const v1::Anatomy& part) {
  return 1e6 * SignedVolume(MeshOf(part).vertices, MeshOf(part).triangles);
}

constexpr v1::Side kLeft = v1::SIDE_LEFT, kRight = v1::SIDE_RIGHT;

TEST(ShoulderGirdle, ClavicleMeetsManubriumAndScapulaWithoutTouching) {
  for (const v1::Side side : {kRight, kLeft}) {
    const v1::Anatomy clavicle = Part(v1::STRUCTURE_CLAVICLE, 0, side);
    for (const v1::Anatomy& bone : {Part(v1::STRUCTURE_MANUBRIUM), Part(v1::STRUCTURE_SCAPULA, 0, side)}) {
      EXPECT_LT(NearestDistance(clavicle, bone), 7) << bone.ShortDebugString();
      EXPECT_GT(SmallestGap(clavicle, bone), 0.5) << bone.ShortDebugString();
    }
  }
}

TEST(ShoulderGirdle, IsOutsideOfTheCage) {
  for (const v1::Anatomy& bone : ShoulderGirdle()) {
    for (int i = 1; i <= 9; ++i) {
      EXPECT_GT(SmallestGap(bone, Part(v1::STRUCTURE_RIB, i, bone.side())), 3) << bone.ShortDebugString() << i;
    }
    EXPECT_GT(SmallestGap(bone, Part(v1::STRUCTURE_COSTAL_CARTILAGE, 1, bone.side())), 3);
    EXPECT_GT(SmallestGap(bone, Part(v1::STRUCTURE_LUNG, 0, bone.side())), 5);
  }
}

TEST(ShoulderGirdle, HasAnAdultsSize) {
  const Mesh& scapula = MeshOf(Part(v1::STRUCTURE_SCAPULA, 0, kLeft));
  const Mesh& clavicle = MeshOf(Part(v1::STRUCTURE_CLAVICLE, 0, kLeft));
  EXPECT_NEAR(High(scapula).z() - Low(scapula).z(), 0.155, 0.015);
  EXPECT_NEAR((High(clavicle) - Low(clavicle)).norm(), 0.145, 0.015);
  EXPECT_NEAR(2 * High(scapula).x(), 0.37, 0.03) << "biacromial breadth";
  EXPECT_NEAR(Low(scapula).x(), 0.06, 0.015) << "medial border";
}

TEST(Kidneys, AreBesideTheSpineBelowTheDiaphragm) {
  for (const v1::Anatomy& kidney : Kidneys()) {
    for (const v1::Structure organ : {v1::STRUCTURE_LIVER, v1::STRUCTURE_SPLEEN, v1::STRUCTURE_STOMACH}) {
      EXPECT_GT(SmallestGap(kidney, Part(organ)), 0.5) << kidney.ShortDebugString() << v1::Structure_Name(organ);
    }
    for (int i = 11; i <= 15; ++i) EXPECT_GT(SmallestGap(kidney, Part(v1::STRUCTURE_VERTEBRA, i)), 1) << i;
    for (int i = 10; i <= 12; ++i) EXPECT_GT(SmallestGap(kidney, Part(v1::STRUCTURE_RIB, i, kidney.side())), 3) << i;
    EXPECT_GT(SmallestGap(kidney, Part(v1::STRUCTURE_VENA_CAVA, 2)), 1);
    EXPECT_GT(SmallestGap(kidney, Part(v1::STRUCTURE_AORTA)), 1);
    EXPECT_NEAR(Millilitres(kidney), 150, 50);
    const double length = High(MeshOf(kidney)).z() - Low(MeshOf(kidney)).z();
    EXPECT_NEAR(length, 0.108, 0.01);
  }
  EXPECT_LT(High(MeshOf(Kidneys()[0])).z(), High(MeshOf(Kidneys()[1])).z() - 0.005) << "the right one is lower";
}

TEST(Kidneys, StayBelowTheSheet) {
  const Mesh& diaphragm = Diaphragm();
  const Points upper = UpperLayer(diaphragm), lower = LowerLayer(diaphragm), middle = (upper + lower) / 2;
  const NearestSearch sheet(middle);
  for (const v1::Anatomy& kidney : Kidneys()) {
    for (const auto& x : MeshOf(kidney).vertices.colwise()) {
      const Neighbour at = sheet.Nearest(x, 15 * kMillimetre);
      if (at.vertex < 0) continue;
      EXPECT_LT((upper.col(at.vertex) - lower.col(at.vertex)).normalized().dot(x - middle.col(at.vertex)), -2e-3);
    }
  }
}

TEST(Lobes, FillTheLungAndKeepApart) {
  for (const v1::Side side : {kRight, kLeft}) {
    double sum = 0;
    for (const v1::Anatomy& lobe : LobesOf(side)) {
      sum += Millilitres(lobe);
      for (const v1::Anatomy& other : LobesOf(side)) {
        if (other.number() == lobe.number()) continue;
        EXPECT_GT(SmallestGap(lobe, other), 0) << lobe.ShortDebugString() << other.ShortDebugString();
        EXPECT_LT(NearestDistance(lobe, other), 4) << "they meet at a fissure";
      }
    }
    const double whole = Millilitres(Part(v1::STRUCTURE_LUNG, 0, side));
    EXPECT_LT(sum, whole);
    EXPECT_GT(sum, 0.93 * whole);
  }
}

TEST(Lobes, HaveTheSharesOfAnAdult) {
  const auto share = [](int number, v1::Side side) {
    return Millilitres(Part(v1::STRUCTURE_LUNG_LOBE, number, side)) / Millilitres(Part(v1::STRUCTURE_LUNG, 0, side));
  };
  EXPECT_NEAR(share(1, kRight), 0.36, 0.1);
  EXPECT_NEAR(share(2, kRight), 0.15, 0.07);
  EXPECT_NEAR(share(3, kRight), 0.47, 0.1);
  EXPECT_NEAR(share(1, kLeft), 0.5, 0.1);
}

TEST(Fissures, LieBetweenTheLobesAndEndAtTheLungsSurface) {
  for (const v1::Anatomy& fissure : Fissures()) {
    const Mesh& sheet = MeshOf(fissure);
    for (const v1::Anatomy& lobe : LobesOf(fissure.side())) {
      EXPECT_GT(SmallestGap(fissure, lobe), -0.6) << fissure.ShortDebugString() << lobe.ShortDebugString();
    }
    EXPECT_LT(NearestDistance(fissure, Part(v1::STRUCTURE_LUNG, 0, fissure.side())), 3);
    EXPECT_LT(Millilitres(fissure), 35) << "a thin sheet";
    EXPECT_GT(sheet.vertices.cols(), 200);
  }
}

// The oblique fissure runs from T3 or the disc below it behind to the sixth rib's end in front, the horizontal one at
// the fourth cartilage.
TEST(Fissures, AreAtTheLevelsOfSurfaceAnatomy) {
  const auto height = [](const Mesh& mesh, bool posterior) {
    Eigen::Index at = 0;
    posterior ? mesh.vertices.row(1).maxCoeff(&at) : mesh.vertices.row(1).minCoeff(&at);
    return mesh.vertices(2, at);
  };
  const Mesh& t3 = MeshOf(Part(v1::STRUCTURE_VERTEBRA, 3));
  for (const v1::Side side : {kRight, kLeft}) {
    const Mesh& oblique = MeshOf(Part(v1::STRUCTURE_FISSURE, 1, side));
    EXPECT_GT(height(oblique, true), Low(t3).z() - 0.02);
    EXPECT_LT(height(oblique, true), High(t3).z() + 0.005);
    const Mesh& rib = MeshOf(Part(v1::STRUCTURE_RIB, 6, side));
    EXPECT_NEAR(height(oblique, false), height(rib, false), 0.03);
  }
  const Mesh& horizontal = MeshOf(Part(v1::STRUCTURE_FISSURE, 2, kRight));
  const Mesh& fourth = MeshOf(Part(v1::STRUCTURE_COSTAL_CARTILAGE, 4, kRight));
  EXPECT_GT(height(horizontal, false), Low(fourth).z() - 0.01);
  EXPECT_LT(height(horizontal, false), High(fourth).z() + 0.01);
}

TEST(Facets, OfTwoVertebraeMeetWithoutCrossing) {
  for (int i = 1; i < 15; ++i) {
    const v1::Anatomy upper = Part(v1::STRUCTURE_VERTEBRA, i), lower = Part(v1::STRUCTURE_VERTEBRA, i + 1);
    // Behind the vertebral bodies, on the left: what is nearest there are the articular processes.
    const double behind = (High(MeshOf(upper)).y() + Low(MeshOf(upper)).y()) / 2 - 0.01;
    const NearestSearch search(MeshOf(lower).vertices);
    double nearest = 1;
    for (const auto& x : MeshOf(upper).vertices.colwise()) {
      if (x.y() > behind && x.x() > 0.008) nearest = std::min(nearest, search.Nearest(x).distance);
    }
    EXPECT_LT(nearest, 3 * kMillimetre) << "facets meet below vertebra " << i;
    EXPECT_GT(SmallestGap(upper, lower), -0.3) << "below vertebra " << i;
  }
}

}  // namespace
}  // namespace phrenic::anatomy
