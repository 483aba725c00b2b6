// The generated thorax: parametric anatomy, any resolution. Dimensions come from published adult values; each part's
// file names its sources.
#ifndef PHRENIC_SERVER_ANATOMY_ANATOMY_H_
#define PHRENIC_SERVER_ANATOMY_ANATOMY_H_

#include "absl/status/statusor.h"
#include "phrenic/v1/scene.pb.h"
#include "server/mesh/mesh.h"

namespace phrenic::anatomy {

// The surface of one part, in metres, in the one frame that all parts share. `resolution_mm` is the aimed edge length;
// 0 takes the part's own default (the diaphragm's gives 20,000 to 21,000 vertices). The same arguments give the same
// bits. The diaphragm comes with the regions "tendon", "muscle", "rim", "crus-right", "crus-left".
// INVALID_ARGUMENT names the field when there is no such part (rib 13, a lung with no side).
absl::StatusOr<Mesh> Generate(const v1::Anatomy& part, double resolution_mm);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_ANATOMY_H_
