// Reads label volumes of DICOM RT Structure Sets (PS3.3, A.19 and C.8.8), as planning systems, MIM, Velocity and 3D
// Slicer write them.
#ifndef PHRENIC_SERVER_IMAGING_RT_STRUCTURES_H_
#define PHRENIC_SERVER_IMAGING_RT_STRUCTURES_H_

#include "absl/status/statusor.h"
#include "server/imaging/label_volume.h"

class DcmDataset;

namespace phrenic::imaging {

// Returns the closed, planar contours of all regions of interest as voxels of 1.5 mm in the plane, or larger ones if
// there would be more than 30 million; slices are those of the contours, which must be axial and equidistant
// (slice_stack.h). A voxel is inside a region if its centre is inside an odd number of its contours in the slice. Where
// regions overlap, the smaller one counts: the body's outline holds all others. Labels are the regions' numbers, or 1,
// 2, ... in their order if a number is not unique or not 1 to 65535. Points and open contours are left out, and
// `remarks` has how many. Reads nothing that identifies a patient. INVALID_ARGUMENT with region, contour, attribute and
// remedy; also for contours whose edges cross more than 50 million rows. Thread-safe.
absl::StatusOr<LabelVolume> ReadRtStructures(DcmDataset& dataset);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_RT_STRUCTURES_H_
