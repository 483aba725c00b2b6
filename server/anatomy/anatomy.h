// The generated thorax: parametric anatomy at any resolution, with published adult dimensions. The header of each
// structure names its sources. Thread-safe.
#ifndef PHRENIC_SERVER_ANATOMY_ANATOMY_H_
#define PHRENIC_SERVER_ANATOMY_ANATOMY_H_

#include <cstdint>

#include "absl/status/statusor.h"
#include "phrenic/v1/scene.pb.h"
#include "server/mesh/mesh.h"

namespace phrenic::anatomy {

// Returns the surface of one structure [m] in the frame common to all structures (LPS, see dimensions.h). It is closed,
// except the inner cage (inner_cage.h) and the diaphragm with SHEET_MIDDLE (middle_sheet.h). `resolution_mm` is the
// target edge length; 0 takes the structure's default (for the diaphragm 20,000 to 21,000 vertices, or about 4,000 with
// SHEET_MIDDLE). Deterministic: the same arguments give the same bits. The diaphragm has the regions "tendon",
// "muscle", "rim", "crus-right" and "crus-left"; SHEET_MIDDLE adds more. INVALID_ARGUMENT names the field if the
// structure does not exist (rib 13, a lung without a side), is no sheet, or the resolution is out of range.
absl::StatusOr<Mesh> Generate(const v1::Anatomy& part, double resolution_mm, v1::Sheet sheet = v1::SHEET_UNSPECIFIED);

// Returns the structure of a person with the shape's physique: that of the adult, carried by PhysiqueMap (physique.h).
// Errors as above; without a physique the same bits.
absl::StatusOr<Mesh> Generate(const v1::Anatomy& part, const v1::Generated& shape);

// Returns about how many vertices Generate gives, without generating; 0 for a part that does not exist.
std::int64_t EstimateVertices(const v1::Anatomy& part, double resolution_mm, v1::Sheet sheet = v1::SHEET_UNSPECIFIED);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_ANATOMY_H_
