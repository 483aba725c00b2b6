#include "server/anatomy/anatomy.h"

#include <cmath>

#include "absl/strings/str_cat.h"
#include "server/anatomy/abdominal_organs.h"
#include "server/anatomy/airways.h"
#include "server/anatomy/cartilage.h"
#include "server/anatomy/diaphragm_mesh.h"
#include "server/anatomy/dimensions.h"
#include "server/anatomy/heart.h"
#include "server/anatomy/inner_cage.h"
#include "server/anatomy/lobes.h"
#include "server/anatomy/lung.h"
#include "server/anatomy/middle_sheet.h"
#include "server/anatomy/physique.h"
#include "server/anatomy/rib.h"
#include "server/anatomy/shoulder_girdle.h"
#include "server/anatomy/sternum.h"
#include "server/anatomy/vertebra.h"
#include "server/anatomy/vessels.h"
#include "server/mesh/units.h"

namespace phrenic::anatomy {
namespace {

constexpr int kCartilages = 10, kVenaeCavae = 2;
constexpr double kCoarsest = 50;  // [mm]

// The default edge length [mm].
double DefaultResolution(v1::Structure structure, v1::Sheet sheet) {
  switch (structure) {
    case v1::STRUCTURE_DIAPHRAGM:
      return sheet == v1::SHEET_MIDDLE ? 5 : 3.16;
    case v1::STRUCTURE_INNER_CAGE:
      return 4;
    case v1::STRUCTURE_LUNG:
      return 5;
    case v1::STRUCTURE_VERTEBRA:
    case v1::STRUCTURE_DISC:
    case v1::STRUCTURE_MANUBRIUM:
    case v1::STRUCTURE_STERNUM_BODY:
      return 3.4;
    case v1::STRUCTURE_XIPHOID:
      return 2.4;
    case v1::STRUCTURE_AORTA:
    case v1::STRUCTURE_VENA_CAVA:
    case v1::STRUCTURE_SPLEEN:
      return 5;
    case v1::STRUCTURE_HEART:
      return 6;
    case v1::STRUCTURE_STOMACH:
      return 6.5;
    case v1::STRUCTURE_LIVER:
    case v1::STRUCTURE_LUNG_LOBE:
      return 7.5;
    case v1::STRUCTURE_KIDNEY:
    case v1::STRUCTURE_FISSURE:
      return 6;
    default:
      return 4.1;
  }
}

// The finest edge length [mm]; bounds the time to seconds and the memory to some hundred megabytes.
double FinestResolution(v1::Structure structure) {
  switch (structure) {
    case v1::STRUCTURE_LUNG:
    case v1::STRUCTURE_VERTEBRA:
    case v1::STRUCTURE_HEART:
    case v1::STRUCTURE_LIVER:
    case v1::STRUCTURE_STOMACH:
    case v1::STRUCTURE_SPLEEN:
    case v1::STRUCTURE_KIDNEY:
    case v1::STRUCTURE_SCAPULA:
    case v1::STRUCTURE_LUNG_LOBE:
    case v1::STRUCTURE_FISSURE:
      return 2;
    default:
      return 1;
  }
}

absl::Status CheckResolution(const v1::Anatomy& part, double resolution_mm) {
  const double finest = FinestResolution(part.structure());
  if (resolution_mm == 0 || (resolution_mm >= finest && resolution_mm <= kCoarsest)) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat("generated.resolution_mm: ", resolution_mm, " is outside ", finest,
                                                 " to ", kCoarsest, " mm for ", v1::Structure_Name(part.structure()),
                                                 "; 0 takes the structure's default"));
}

absl::Status CheckSheet(const v1::Anatomy& part, v1::Sheet sheet) {
  if (sheet == v1::SHEET_UNSPECIFIED || part.structure() == v1::STRUCTURE_DIAPHRAGM) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat("generated.sheet: ", v1::Structure_Name(part.structure()),
                                                 " is no sheet; leave it out, or use STRUCTURE_DIAPHRAGM"));
}

absl::Status NeedsSide(const v1::Anatomy& part) {
  if (part.side() == v1::SIDE_LEFT || part.side() == v1::SIDE_RIGHT) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat("anatomy.side: ", v1::Structure_Name(part.structure()),
                                                 " needs a side; set SIDE_RIGHT or SIDE_LEFT"));
}

absl::Status NeedsNumber(const v1::Anatomy& part, int last) {
  if (part.number() >= 1 && part.number() <= last) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat("anatomy.number: there is no ", v1::Structure_Name(part.structure()),
                                                 " ", part.number(), " in the generated thorax; use 1 to ", last));
}

// The left lung has an upper and a lower lobe, and no horizontal fissure.
absl::Status NeedsPartOfLung(const v1::Anatomy& part) {
  const bool lobe = part.structure() == v1::STRUCTURE_LUNG_LOBE;
  if (absl::Status status = NeedsNumber(part, lobe ? 3 : 2); !status.ok()) return status;
  if (absl::Status status = NeedsSide(part); !status.ok()) return status;
  if (part.side() == v1::SIDE_RIGHT || part.number() == (lobe ? 3 : 1) || (lobe && part.number() == 1)) {
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(
      absl::StrCat("anatomy.number: the left lung has no ",
                   lobe ? "middle lobe; use 1 (upper) or 3 (lower)" : "horizontal fissure; use 1 (oblique)"));
}

absl::Status CheckPart(const v1::Anatomy& part) {
  switch (part.structure()) {
    case v1::STRUCTURE_DIAPHRAGM:
    case v1::STRUCTURE_MANUBRIUM:
    case v1::STRUCTURE_STERNUM_BODY:
    case v1::STRUCTURE_XIPHOID:
    case v1::STRUCTURE_INNER_CAGE:
    case v1::STRUCTURE_HEART:
    case v1::STRUCTURE_AORTA:
    case v1::STRUCTURE_OESOPHAGUS:
    case v1::STRUCTURE_TRACHEA:
    case v1::STRUCTURE_LIVER:
    case v1::STRUCTURE_STOMACH:
    case v1::STRUCTURE_SPLEEN:
      return absl::OkStatus();
    case v1::STRUCTURE_VERTEBRA:
      return NeedsNumber(part, kVertebrae);
    case v1::STRUCTURE_DISC:
      return NeedsNumber(part, kDiscs);
    case v1::STRUCTURE_VENA_CAVA:
      return NeedsNumber(part, kVenaeCavae);
    case v1::STRUCTURE_LUNG:
    case v1::STRUCTURE_CLAVICLE:
    case v1::STRUCTURE_SCAPULA:
    case v1::STRUCTURE_KIDNEY:
      return NeedsSide(part);
    case v1::STRUCTURE_LUNG_LOBE:
    case v1::STRUCTURE_FISSURE:
      return NeedsPartOfLung(part);
    case v1::STRUCTURE_RIB:
      if (absl::Status status = NeedsNumber(part, kRibs); !status.ok()) return status;
      return NeedsSide(part);
    case v1::STRUCTURE_COSTAL_CARTILAGE:
      if (absl::Status status = NeedsNumber(part, kCartilages); !status.ok()) return status;
      return NeedsSide(part);
    default:
      return absl::InvalidArgumentError("anatomy.structure: set the structure to generate, for example STRUCTURE_RIB");
  }
}

Mesh OnSide(const v1::Anatomy& part, Mesh left) {
  return part.side() == v1::SIDE_RIGHT ? Mirrored(std::move(left)) : std::move(left);
}

Mesh Organ(const v1::Anatomy& part, double edge_length) {
  switch (part.structure()) {
    case v1::STRUCTURE_HEART:
      return Heart(edge_length);
    case v1::STRUCTURE_AORTA:
      return Aorta(edge_length);
    case v1::STRUCTURE_VENA_CAVA:
      return part.number() == 1 ? SuperiorVenaCava(edge_length) : InferiorVenaCava(edge_length);
    case v1::STRUCTURE_OESOPHAGUS:
      return Oesophagus(edge_length);
    case v1::STRUCTURE_TRACHEA:
      return Trachea(edge_length);
    case v1::STRUCTURE_LIVER:
      return Liver(edge_length);
    case v1::STRUCTURE_STOMACH:
      return Stomach(edge_length);
    case v1::STRUCTURE_SPLEEN:
      return Spleen(edge_length);
    case v1::STRUCTURE_KIDNEY:
      return part.side() == v1::SIDE_RIGHT ? RightKidney(edge_length) : LeftKidney(edge_length);
    case v1::STRUCTURE_LUNG_LOBE:
      return LungLobe(static_cast<Lobe>(part.number()), part.side() == v1::SIDE_LEFT, edge_length);
    case v1::STRUCTURE_FISSURE:
      return LungFissure(static_cast<Fissure>(part.number()), part.side() == v1::SIDE_LEFT, edge_length);
    default:
      return {};
  }
}

Mesh InMillimetres(const v1::Anatomy& part, double edge_length, v1::Sheet sheet) {
  switch (part.structure()) {
    case v1::STRUCTURE_DIAPHRAGM:
      return sheet == v1::SHEET_MIDDLE ? MiddleSheet(edge_length) : DiaphragmMesh(edge_length);
    case v1::STRUCTURE_INNER_CAGE:
      return InnerCage(edge_length);
    case v1::STRUCTURE_RIB:
      return OnSide(part, LeftRib(part.number(), edge_length));
    case v1::STRUCTURE_COSTAL_CARTILAGE:
      return OnSide(part, LeftCartilage(part.number(), edge_length));
    case v1::STRUCTURE_MANUBRIUM:
      return Manubrium(edge_length);
    case v1::STRUCTURE_STERNUM_BODY:
      return SternumBody(edge_length);
    case v1::STRUCTURE_XIPHOID:
      return Xiphoid(edge_length);
    case v1::STRUCTURE_VERTEBRA:
      return Vertebra(part.number(), edge_length);
    case v1::STRUCTURE_DISC:
      return Disc(part.number(), edge_length);
    case v1::STRUCTURE_CLAVICLE:
      return OnSide(part, LeftClavicle(edge_length));
    case v1::STRUCTURE_SCAPULA:
      return OnSide(part, LeftScapula(edge_length));
    case v1::STRUCTURE_LUNG:
      return part.side() == v1::SIDE_RIGHT ? RightLung(edge_length) : LeftLung(edge_length);
    default:
      return Organ(part, edge_length);
  }
}

// The area of a structure's surface, so that area / edge length^2 estimates its vertices [mm^2].
double Area(v1::Structure structure, v1::Sheet sheet) {
  switch (structure) {
    case v1::STRUCTURE_DIAPHRAGM:
      return sheet == v1::SHEET_MIDDLE ? 100'000 : 220'000;
    case v1::STRUCTURE_INNER_CAGE:
      return 230'000;
    case v1::STRUCTURE_LUNG:
      return 110'000;
    case v1::STRUCTURE_VERTEBRA:
      return 12'000;
    case v1::STRUCTURE_COSTAL_CARTILAGE:
      return 5'000;
    case v1::STRUCTURE_XIPHOID:
      return 2'000;
    case v1::STRUCTURE_DISC:
      return 5'000;
    case v1::STRUCTURE_HEART:
    case v1::STRUCTURE_STOMACH:
      return 50'000;
    case v1::STRUCTURE_LIVER:
      return 90'000;
    case v1::STRUCTURE_LUNG_LOBE:
      return 60'000;
    case v1::STRUCTURE_AORTA:
    case v1::STRUCTURE_SPLEEN:
    case v1::STRUCTURE_SCAPULA:
    case v1::STRUCTURE_FISSURE:
      return 25'000;
    default:
      return 11'000;
  }
}

double ResolutionOf(const v1::Anatomy& part, double resolution_mm, v1::Sheet sheet) {
  return resolution_mm == 0 ? DefaultResolution(part.structure(), sheet) : resolution_mm;
}

}  // namespace

std::int64_t EstimateVertices(const v1::Anatomy& part, double resolution_mm, v1::Sheet sheet) {
  if (!CheckPart(part).ok() || !CheckResolution(part, resolution_mm).ok()) return 0;
  const double edge = ResolutionOf(part, resolution_mm, sheet);
  return static_cast<std::int64_t>(Area(part.structure(), sheet) / (edge * edge));
}

absl::StatusOr<Mesh> Generate(const v1::Anatomy& part, const v1::Generated& shape) {
  const PhysiqueMap map(shape.physique());
  if (map.IsIdentity()) return Generate(part, shape.resolution_mm(), shape.sheet());
  if (part.structure() == v1::STRUCTURE_INNER_CAGE) {
    if (absl::Status status = CheckPart(part); !status.ok()) return status;
    if (absl::Status status = CheckSheet(part, shape.sheet()); !status.ok()) return status;
    if (absl::Status status = CheckResolution(part, shape.resolution_mm()); !status.ok()) return status;
    Mesh cage = InnerCage(ResolutionOf(part, shape.resolution_mm(), shape.sheet()), map);
    cage.vertices *= kMillimetre;
    return cage;
  }
  absl::StatusOr<Mesh> mesh = Generate(part, shape.resolution_mm(), shape.sheet());
  if (!mesh.ok()) return mesh;
  for (auto vertex : mesh->vertices.colwise()) vertex = kMillimetre * map(vertex / kMillimetre);
  return mesh;
}

absl::StatusOr<Mesh> Generate(const v1::Anatomy& part, double resolution_mm, v1::Sheet sheet) {
  if (absl::Status status = CheckPart(part); !status.ok()) return status;
  if (absl::Status status = CheckSheet(part, sheet); !status.ok()) return status;
  if (absl::Status status = CheckResolution(part, resolution_mm); !status.ok()) return status;
  Mesh mesh = InMillimetres(part, ResolutionOf(part, resolution_mm, sheet), sheet);
  mesh.vertices *= kMillimetre;
  return mesh;
}

}  // namespace phrenic::anatomy
