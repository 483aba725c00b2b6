// The structures of the generated thorax fit together.
#include <gtest/gtest.h>

#include <map>

#include "server/mesh/nearest.h"
#include "server/mesh/normals.h"
#include "server/mesh/topology.h"
#include "server/mesh/units.h"
#include "tests/anatomy/parts.h"

namespace phrenic::anatomy {
namespace {

Points VerticesOf(const std::vector<v1::Anatomy>& parts) {
  Points all(3, 0);
  for (const v1::Anatomy& part : parts) {
    const Mesh mesh = MeshOf(part);
    all.conservativeResize(3, all.cols() + mesh.vertices.cols());
    all.rightCols(mesh.vertices.cols()) = mesh.vertices;
  }
  return all;
}

Mesh Rib(int number, v1::Side side) { return MeshOf(Part(v1::STRUCTURE_RIB, number, side)); }
Mesh Vertebra(int number) { return MeshOf(Part(v1::STRUCTURE_VERTEBRA, number)); }
Mesh Lung(v1::Side side) { return MeshOf(Part(v1::STRUCTURE_LUNG, 0, side)); }

TEST(Thorax, RimIsCloseToTheBonesOfItsInsertion) {
  const Mesh diaphragm = Diaphragm();
  const NearestSearch bones(VerticesOf(Bones()));
  // The region is a band; take its vertex nearest to bone in each 10 degrees around the body.
  std::map<int, double> nearest;
  for (const int i : diaphragm.regions.at("rim")) {
    const Eigen::Vector3d x = diaphragm.vertices.col(i);
    const int sector = static_cast<int>(std::floor(std::atan2(x.x(), -x.y()) * 18 / M_PI));
    const double distance = bones.Nearest(x).distance;
    nearest[sector] = nearest.contains(sector) ? std::min(nearest[sector], distance) : distance;
    EXPECT_LT(distance, 21 * kMillimetre);
  }
  EXPECT_GE(nearest.size(), 35u) << "the rim surrounds the body";
  for (const auto& [sector, distance] : nearest) {
    EXPECT_GT(distance, 1 * kMillimetre) << sector;
    EXPECT_LT(distance, 12 * kMillimetre) << sector;
  }
}

TEST(Thorax, CruraLieOnTheLumbarBodies) {
  const Mesh diaphragm = Diaphragm();
  const NearestSearch spine(VerticesOf({Part(v1::STRUCTURE_VERTEBRA, 12), Part(v1::STRUCTURE_VERTEBRA, 13),
                                        Part(v1::STRUCTURE_VERTEBRA, 14), Part(v1::STRUCTURE_VERTEBRA, 15)}));
  for (const char* crus : {"crus-right", "crus-left"}) {
    for (const int i : diaphragm.regions.at(crus)) {
      EXPECT_LT(spine.Nearest(diaphragm.vertices.col(i)).distance, 18 * kMillimetre) << crus;
    }
  }
}

// Bones near the sheet are on its thoracic side: at positive distance from the middle surface along its normal.
TEST(Thorax, NoBonePiercesTheDiaphragm) {
  const Mesh diaphragm = Diaphragm();
  const Points upper = UpperLayer(diaphragm), lower = LowerLayer(diaphragm);
  const Points middle = (upper + lower) / 2, across = upper - lower;
  const NearestSearch sheet(middle);
  for (const v1::Anatomy& part : Bones()) {
    const Mesh bone = MeshOf(part);
    for (Eigen::Index i = 0; i < bone.vertices.cols(); ++i) {
      const Neighbour at = sheet.Nearest(bone.vertices.col(i));
      if (at.distance > 10 * kMillimetre) continue;
      const Eigen::Vector3d offset = bone.vertices.col(i) - middle.col(at.vertex);
      EXPECT_GT(offset.dot(across.col(at.vertex).normalized()), 1.5 * kMillimetre) << part.ShortDebugString();
    }
  }
}

TEST(Thorax, RightAndLeftRibsMirrorEachOther) {
  for (int i = 1; i <= 12; ++i) {
    const Mesh right = Rib(i, v1::SIDE_RIGHT), left = Rib(i, v1::SIDE_LEFT);
    ASSERT_EQ(right.vertices.cols(), left.vertices.cols());
    EXPECT_EQ(right.vertices.row(0), -left.vertices.row(0));
    EXPECT_EQ(right.vertices.bottomRows(2), left.vertices.bottomRows(2));
    EXPECT_LT(right.vertices.row(0).maxCoeff(), 0);
  }
}

TEST(Thorax, RibsDescendFromHeadsAtTheirVertebrae) {
  for (int i = 1; i <= 12; ++i) {
    const Mesh rib = Rib(i, v1::SIDE_LEFT), vertebra = Vertebra(i);
    Eigen::Index head = 0, end = 0;
    rib.vertices.row(0).minCoeff(&head);
    (i == 12 ? rib.vertices.row(2) : rib.vertices.row(1)).minCoeff(&end);  // the anterior end
    const NearestSearch bone(vertebra.vertices);
    EXPECT_LT(bone.Nearest(rib.vertices.col(head)).distance, 8 * kMillimetre) << "rib " << i;
    EXPECT_GT(rib.vertices(2, head) - rib.vertices(2, end), 35 * kMillimetre) << "rib " << i;
    EXPECT_GT(rib.vertices(1, head) - rib.vertices(1, end), i == 12 ? -0.03 : 0.03) << "forwards, rib " << i;
  }
}

TEST(Thorax, MiddleRibsAreTheLongest) {
  const auto extent = [](int i) { return (High(Rib(i, v1::SIDE_LEFT)) - Low(Rib(i, v1::SIDE_LEFT))).norm(); };
  for (int i = 1; i < 6; ++i) EXPECT_LT(extent(i), extent(i + 1));
  for (int i = 8; i < 12; ++i) EXPECT_GT(extent(i), extent(i + 1));
}

TEST(Thorax, CartilagesJoinRibAndSternumOrTheCartilageAbove) {
  const Points sternum = VerticesOf({Part(v1::STRUCTURE_MANUBRIUM), Part(v1::STRUCTURE_STERNUM_BODY)});
  for (int i = 1; i <= 10; ++i) {
    const Mesh cartilage = MeshOf(Part(v1::STRUCTURE_COSTAL_CARTILAGE, i, v1::SIDE_LEFT));
    const NearestSearch rib(Rib(i, v1::SIDE_LEFT).vertices);
    const v1::Anatomy above = Part(v1::STRUCTURE_COSTAL_CARTILAGE, i - 1, v1::SIDE_LEFT);
    const NearestSearch other(i < 8 ? sternum : MeshOf(above).vertices);
    double to_rib = 1, to_other = 1;
    for (Eigen::Index k = 0; k < cartilage.vertices.cols(); ++k) {
      to_rib = std::min(to_rib, rib.Nearest(cartilage.vertices.col(k)).distance);
      to_other = std::min(to_other, other.Nearest(cartilage.vertices.col(k)).distance);
    }
    EXPECT_LT(to_rib, 3 * kMillimetre) << i;
    EXPECT_LT(to_other, 4 * kMillimetre) << i;
  }
}

TEST(Thorax, CartilagesContinueRibsWithoutAStep) {
  for (int i = 1; i <= 10; ++i) {
    const NearestSearch rib(Rib(i, v1::SIDE_LEFT).vertices);
    const Mesh cartilage = MeshOf(Part(v1::STRUCTURE_COSTAL_CARTILAGE, i, v1::SIDE_LEFT));
    int met = 0;
    for (const auto& x : cartilage.vertices.colwise()) met += rib.Nearest(x).distance < 0.1 * kMillimetre ? 1 : 0;
    EXPECT_GE(met, 10) << "a ring of vertices, cartilage " << i;
  }
}

TEST(Thorax, LungsLieAboveTheDomesAndLeaveTheRecessEmpty) {
  const Mesh diaphragm = Diaphragm();
  const Points normals = VertexNormals(diaphragm.vertices, diaphragm.triangles);
  const NearestSearch thoracic(UpperLayer(diaphragm));
  for (const v1::Side side : {v1::SIDE_RIGHT, v1::SIDE_LEFT}) {
    const Mesh lung = Lung(side);
    double closest = 1;
    for (Eigen::Index i = 0; i < lung.vertices.cols(); ++i) {
      const Neighbour at = thoracic.Nearest(lung.vertices.col(i));
      closest = std::min(closest, at.distance);
      if (at.distance > 15 * kMillimetre) continue;
      const int facing = UpperVertex(at.vertex);
      const Eigen::Vector3d offset = lung.vertices.col(i) - diaphragm.vertices.col(facing);
      EXPECT_GT(offset.dot(normals.col(facing)), 0) << "above the thoracic layer";
    }
    EXPECT_LT(closest, 5 * kMillimetre);
    double rim = 1;
    for (const int i : diaphragm.regions.at("rim")) rim = std::min(rim, diaphragm.vertices(2, i));
    EXPECT_GT(Low(lung).z() - rim, 0.05) << "zone of apposition";
  }
}

TEST(Thorax, RibsEncloseTheLungs) {
  for (const v1::Side side : {v1::SIDE_RIGHT, v1::SIDE_LEFT}) {
    const Mesh lung = Lung(side);
    const Points normals = VertexNormals(lung.vertices, lung.triangles);
    const NearestSearch surface(lung.vertices);
    for (int i = 1; i <= 10; ++i) {
      const Mesh rib = Rib(i, side);
      for (Eigen::Index k = 0; k < rib.vertices.cols(); ++k) {
        const Neighbour at = surface.Nearest(rib.vertices.col(k));
        if (at.distance > 12 * kMillimetre) continue;
        const Eigen::Vector3d offset = rib.vertices.col(k) - lung.vertices.col(at.vertex);
        EXPECT_GT(offset.dot(normals.col(at.vertex)), -2 * kMillimetre) << "rib " << i;
      }
    }
    EXPECT_GT(High(lung).z(), Low(Rib(1, side)).z() + 0.03) << "the apex rises above the first rib's end";
  }
}

TEST(Thorax, LungsHoldAnAdultsVolumeAndTheRightIsLarger) {
  const Mesh right = Lung(v1::SIDE_RIGHT), left = Lung(v1::SIDE_LEFT);
  const double r = SignedVolume(right.vertices, right.triangles), l = SignedVolume(left.vertices, left.triangles);
  EXPECT_GT(r, l);
  EXPECT_GT(r + l, 2.5e-3);
  EXPECT_LT(r + l, 4e-3);
}

TEST(Thorax, VertebralBodiesStackWithoutOverlap) {
  for (int i = 1; i < 15; ++i) {
    const Mesh upper = Vertebra(i), lower = Vertebra(i + 1);
    EXPECT_GT((High(upper) + Low(upper)).z() / 2, (High(lower) + Low(lower)).z() / 2 + 0.012) << i;
    EXPECT_LT(SignedVolume(upper.vertices, upper.triangles), 1.15 * SignedVolume(lower.vertices, lower.triangles));
  }
}

}  // namespace
}  // namespace phrenic::anatomy
