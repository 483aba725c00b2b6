#include "tests/anatomy/parts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/mesh/self_crossings.h"
#include "server/mesh/topology.h"

namespace phrenic::anatomy {
namespace {

int Genus(v1::Structure structure) {
  if (structure == v1::STRUCTURE_DIAPHRAGM) return 2;  // caval and oesophageal opening
  return structure == v1::STRUCTURE_VERTEBRA ? 1 : 0;  // the vertebral canal
}

void ExpectValidSurface(const v1::Anatomy& part, double resolution_mm) {
  SCOPED_TRACE(part.ShortDebugString() + " at " + std::to_string(resolution_mm) + " mm");
  const auto mesh = Generate(part, resolution_mm);
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_TRUE(Validate(*mesh).ok());
  const SurfaceTopology topology = AnalyseTopology(*mesh);
  EXPECT_TRUE(topology.watertight());
  EXPECT_EQ(topology.vertices, mesh->vertices.cols()) << "every vertex is used";
  EXPECT_EQ(topology.components, 1);
  EXPECT_EQ(topology.genus(), Genus(part.structure()));
  EXPECT_EQ(topology.degenerate_triangles, 0);
  EXPECT_GT(SignedVolume(mesh->vertices, mesh->triangles), 1e-7) << "faces outwards";
  EXPECT_GT(SmallestAngle(*mesh), 4);
}

TEST(Parts, SurfacesAreClosedOutwardAndConnected) {
  for (const v1::Anatomy& part : AllParts()) ExpectValidSurface(part, 0);
}

TEST(Parts, SurfacesDoNotCrossThemselves) {
  constexpr double kCell = 6e-3;  // about the longest edge [m]
  for (const v1::Anatomy& part : AllParts()) {
    EXPECT_EQ(SelfCrossings(MeshOf(part), kCell), 0) << part.ShortDebugString();
  }
}

TEST(Parts, StayClosedAtCoarseResolutions) {
  for (const double resolution_mm : {7.0, 12.0, 20.0}) {
    for (const v1::Anatomy& part : AllParts()) ExpectValidSurface(part, resolution_mm);
  }
}

TEST(Parts, DiaphragmAndRibsStayClosedAtFineResolutions) {
  ExpectValidSurface(Part(v1::STRUCTURE_DIAPHRAGM), 2);
  ExpectValidSurface(Part(v1::STRUCTURE_RIB, 1, v1::SIDE_LEFT), 2);
  ExpectValidSurface(Part(v1::STRUCTURE_RIB, 7, v1::SIDE_RIGHT), 1);
  ExpectValidSurface(Part(v1::STRUCTURE_VERTEBRA, 5), 2);
}

TEST(Parts, DefaultResolutionsSuitStreaming) {
  Eigen::Index bones = 0;
  for (const v1::Anatomy& part : Bones()) bones += MeshOf(part).vertices.cols();
  EXPECT_LT(bones, 60000);
  Eigen::Index organs = 0;
  for (const v1::Anatomy& part : Mediastinum()) organs += MeshOf(part).vertices.cols();
  for (const v1::Anatomy& part : AbdominalOrgans()) organs += MeshOf(part).vertices.cols();
  EXPECT_LT(organs, 20000);
  for (const v1::Side side : {v1::SIDE_LEFT, v1::SIDE_RIGHT}) {
    const Eigen::Index lung = MeshOf(Part(v1::STRUCTURE_LUNG, 0, side)).vertices.cols();
    EXPECT_GT(lung, 3000);
    EXPECT_LT(lung, 5000);
  }
}

TEST(Parts, FinerResolutionGivesMoreVertices) {
  for (const v1::Anatomy& part : {Part(v1::STRUCTURE_RIB, 5, v1::SIDE_LEFT), Part(v1::STRUCTURE_VERTEBRA, 12),
                                  Part(v1::STRUCTURE_DIAPHRAGM), Part(v1::STRUCTURE_MANUBRIUM)}) {
    EXPECT_GT(MeshOf(part, 3).vertices.cols(), 1.5 * static_cast<double>(MeshOf(part, 5).vertices.cols()));
  }
}

TEST(Parts, VerticesAreEstimatedWithoutGenerating) {
  for (const double resolution_mm : {0.0, 7.0}) {
    for (const v1::Anatomy& part : AllParts()) {
      const auto vertices = MeshOf(part, resolution_mm).vertices.cols(),
                 estimate = EstimateVertices(part, resolution_mm);
      EXPECT_LE(vertices, 4 * estimate) << part.ShortDebugString() << resolution_mm;
      EXPECT_LE(estimate, 10 * vertices) << part.ShortDebugString() << resolution_mm;
    }
  }
  EXPECT_EQ(EstimateVertices(Part(v1::STRUCTURE_RIB, 13, v1::SIDE_LEFT), 0), 0);
}

TEST(Parts, SameArgumentsGiveTheSameBits) {
  for (const v1::Anatomy& part :
       {Part(v1::STRUCTURE_DIAPHRAGM), Part(v1::STRUCTURE_RIB, 3, v1::SIDE_LEFT), Part(v1::STRUCTURE_VERTEBRA, 9),
        Part(v1::STRUCTURE_LUNG, 0, v1::SIDE_LEFT), Part(v1::STRUCTURE_LIVER)}) {
    const auto first = Generate(part, 6), second = Generate(part, 6);
    ASSERT_TRUE(first.ok() && second.ok());
    EXPECT_EQ(first->vertices, second->vertices);
    EXPECT_EQ(first->triangles, second->triangles);
    EXPECT_EQ(first->regions, second->regions);
  }
}

void ExpectRejected(const v1::Anatomy& part, double resolution_mm, const std::string& field) {
  const auto mesh = Generate(part, resolution_mm);
  ASSERT_FALSE(mesh.ok()) << part.ShortDebugString();
  EXPECT_EQ(mesh.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(mesh.status().message()), testing::HasSubstr(field));
}

TEST(Parts, UnknownPartsAreRejectedByField) {
  ExpectRejected(Part(v1::STRUCTURE_UNSPECIFIED), 0, "anatomy.structure");
  ExpectRejected(Part(v1::STRUCTURE_RIB, 13, v1::SIDE_LEFT), 0, "anatomy.number");
  ExpectRejected(Part(v1::STRUCTURE_RIB, 0, v1::SIDE_LEFT), 0, "anatomy.number");
  ExpectRejected(Part(v1::STRUCTURE_RIB, 4), 0, "anatomy.side");
  ExpectRejected(Part(v1::STRUCTURE_COSTAL_CARTILAGE, 11, v1::SIDE_RIGHT), 0, "anatomy.number");
  ExpectRejected(Part(v1::STRUCTURE_COSTAL_CARTILAGE, 2), 0, "anatomy.side");
  ExpectRejected(Part(v1::STRUCTURE_VERTEBRA, 16), 0, "anatomy.number");
  ExpectRejected(Part(v1::STRUCTURE_LUNG), 0, "anatomy.side");
  ExpectRejected(Part(v1::STRUCTURE_DISC, 15), 0, "anatomy.number");
  ExpectRejected(Part(v1::STRUCTURE_VENA_CAVA), 0, "anatomy.number");
  ExpectRejected(Part(v1::STRUCTURE_CLAVICLE), 0, "anatomy.side");
  ExpectRejected(Part(v1::STRUCTURE_SCAPULA), 0, "anatomy.side");
  ExpectRejected(Part(v1::STRUCTURE_KIDNEY), 0, "anatomy.side");
  ExpectRejected(Part(v1::STRUCTURE_LUNG_LOBE, 1), 0, "anatomy.side");
  ExpectRejected(Part(v1::STRUCTURE_LUNG_LOBE, 4, v1::SIDE_RIGHT), 0, "anatomy.number");
  ExpectRejected(Part(v1::STRUCTURE_LUNG_LOBE, 2, v1::SIDE_LEFT), 0, "no middle lobe");
  ExpectRejected(Part(v1::STRUCTURE_FISSURE, 2, v1::SIDE_LEFT), 0, "no horizontal fissure");
}

TEST(Parts, ResolutionOutOfRangeIsRejected) {
  for (const double resolution_mm : {-1.0, 0.1, 51.0, std::nan("")}) {
    ExpectRejected(Part(v1::STRUCTURE_DIAPHRAGM), resolution_mm, "generated.resolution_mm");
  }
  ExpectRejected(Part(v1::STRUCTURE_LUNG, 0, v1::SIDE_LEFT), 1, "generated.resolution_mm");
}

}  // namespace
}  // namespace phrenic::anatomy
