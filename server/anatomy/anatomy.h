// The generated thorax: parametric anatomy at any resolution, with published adult dimensions. The header of each
// structure names its sources. Thread-safe.
#ifndef PHRENIC_SERVER_ANATOMY_ANATOMY_H_
#define PHRENIC_SERVER_ANATOMY_ANATOMY_H_

#include <cstdint>

#include "absl/status/statusor.h"
#include "phrenic/v1/scene.pb.h"
#include "server/mesh/mesh.h"

namespace phrenic::anatomy {

// Returns the closed surface of one structure [m] in the frame common to all structures (LPS, see dimensions.h).
// `resolution_mm` is the target edge length; 0 takes the structure's default (for the diaphragm 20,000 to 21,000
// vertices). Deterministic: the same arguments give the same bits. The diaphragm has the regions "tendon", "muscle",
// "rim", "crus-right" and "crus-left". INVALID_ARGUMENT names the field if the structure does not exist (rib 13, a lung
// without a side) or the resolution is out of range.
absl::StatusOr<Mesh> Generate(const v1::Anatomy& part, double resolution_mm);

// Returns about how many vertices Generate gives, without generating; 0 for a part that does not exist.
std::int64_t EstimateVertices(const v1::Anatomy& part, double resolution_mm);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_ANATOMY_H_
