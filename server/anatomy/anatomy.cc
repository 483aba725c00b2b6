#include "server/anatomy/anatomy.h"

#include <cmath>

#include "absl/strings/str_cat.h"
#include "server/anatomy/cartilage.h"
#include "server/anatomy/diaphragm_mesh.h"
#include "server/anatomy/dimensions.h"
#include "server/anatomy/lung.h"
#include "server/anatomy/rib.h"
#include "server/anatomy/sternum.h"
#include "server/anatomy/vertebra.h"
#include "server/mesh/units.h"

namespace phrenic::anatomy {
namespace {

constexpr int kCartilages = 10;
constexpr double kCoarsest = 50;  // [mm]

// The default edge length [mm].
double DefaultResolution(v1::Structure structure) {
  switch (structure) {
    case v1::STRUCTURE_DIAPHRAGM:
      return 3.16;
    case v1::STRUCTURE_LUNG:
      return 5;
    case v1::STRUCTURE_VERTEBRA:
      return 3.4;
    default:
      return 4.1;
  }
}

// The finest edge length [mm]; bounds the time to seconds and the memory to some hundred megabytes.
double FinestResolution(v1::Structure structure) {
  return structure == v1::STRUCTURE_LUNG || structure == v1::STRUCTURE_VERTEBRA ? 2 : 1;
}

absl::Status CheckResolution(const v1::Anatomy& part, double resolution_mm) {
  const double finest = FinestResolution(part.structure());
  if (resolution_mm == 0 || (resolution_mm >= finest && resolution_mm <= kCoarsest)) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat("generated.resolution_mm: ", resolution_mm, " is outside ", finest,
                                                 " to ", kCoarsest, " mm for ", v1::Structure_Name(part.structure()),
                                                 "; 0 takes the structure's default"));
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

absl::Status CheckPart(const v1::Anatomy& part) {
  switch (part.structure()) {
    case v1::STRUCTURE_DIAPHRAGM:
    case v1::STRUCTURE_MANUBRIUM:
    case v1::STRUCTURE_STERNUM_BODY:
    case v1::STRUCTURE_XIPHOID:
      return absl::OkStatus();
    case v1::STRUCTURE_VERTEBRA:
      return NeedsNumber(part, kVertebrae);
    case v1::STRUCTURE_LUNG:
      return NeedsSide(part);
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

Mesh InMillimetres(const v1::Anatomy& part, double edge_length) {
  switch (part.structure()) {
    case v1::STRUCTURE_DIAPHRAGM:
      return DiaphragmMesh(edge_length);
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
    case v1::STRUCTURE_LUNG:
      return part.side() == v1::SIDE_RIGHT ? RightLung(edge_length) : LeftLung(edge_length);
    default:
      return {};
  }
}

// The area of a structure's surface, so that area / edge length^2 estimates its vertices [mm^2].
double Area(v1::Structure structure) {
  switch (structure) {
    case v1::STRUCTURE_DIAPHRAGM:
      return 220'000;
    case v1::STRUCTURE_LUNG:
      return 110'000;
    case v1::STRUCTURE_VERTEBRA:
      return 12'000;
    case v1::STRUCTURE_COSTAL_CARTILAGE:
      return 4'000;
    case v1::STRUCTURE_XIPHOID:
      return 2'000;
    default:
      return 11'000;
  }
}

double ResolutionOf(const v1::Anatomy& part, double resolution_mm) {
  return resolution_mm == 0 ? DefaultResolution(part.structure()) : resolution_mm;
}

}  // namespace

std::int64_t EstimateVertices(const v1::Anatomy& part, double resolution_mm) {
  if (!CheckPart(part).ok() || !CheckResolution(part, resolution_mm).ok()) return 0;
  const double edge = ResolutionOf(part, resolution_mm);
  return static_cast<std::int64_t>(Area(part.structure()) / (edge * edge));
}

absl::StatusOr<Mesh> Generate(const v1::Anatomy& part, double resolution_mm) {
  if (absl::Status status = CheckPart(part); !status.ok()) return status;
  if (absl::Status status = CheckResolution(part, resolution_mm); !status.ok()) return status;
  Mesh mesh = InMillimetres(part, ResolutionOf(part, resolution_mm));
  mesh.vertices *= kMillimetre;
  return mesh;
}

}  // namespace phrenic::anatomy
