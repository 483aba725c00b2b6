// The parts of a thorax from closed surfaces instead of a segmentation, so that the same methods derive the rest of it.
#ifndef PHRENIC_SERVER_IMAGING_SURFACES_VOXELISED_PARTS_H_
#define PHRENIC_SERVER_IMAGING_SURFACES_VOXELISED_PARTS_H_

#include <functional>
#include <vector>

#include "absl/status/statusor.h"
#include "server/imaging/patient/patient_body.h"
#include "server/imaging/segmented_parts.h"

namespace phrenic::imaging {

// Asked before each part of a long computation; an error ends it.
using GoOn = std::function<absl::Status()>;
inline absl::Status AlwaysGoOn() { return absl::OkStatus(); }

struct VoxelisedParts {
  LabelVolume volume;  // the grid alone: no voxel has a label
  std::vector<Part> parts;
};

// Returns a part for each body, in voxels of 1.5 mm, or larger ones if the bodies are larger than a person: at most 20
// million in all. A surface with small holes is voxelised but for some lines of voxels. INVALID_ARGUMENT names the body
// that has no triangles or encloses no voxel; also without bodies, or if they extend over more than 3 m.
// RESOURCE_EXHAUSTED if the parts have more than 200 million voxels together. The errors of `go_on`.
absl::StatusOr<VoxelisedParts> VoxeliseParts(const std::vector<PatientBody>& bodies, const GoOn& go_on = AlwaysGoOn);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_SURFACES_VOXELISED_PARTS_H_
