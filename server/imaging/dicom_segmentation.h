// Reads label volumes of DICOM Segmentation objects (PS3.3, A.51 and C.8.20), as hospitals' archives, 3D Slicer
// (dcmqi), highdicom and TotalSegmentator write them.
#ifndef PHRENIC_SERVER_IMAGING_DICOM_SEGMENTATION_H_
#define PHRENIC_SERVER_IMAGING_DICOM_SEGMENTATION_H_

#include <string_view>

#include "absl/status/statusor.h"
#include "server/imaging/label_volume.h"

namespace phrenic::imaging {

// Parses a segmentation of type BINARY (1 bit a voxel, packed over the borders of frames; 8 bits), FRACTIONAL (at least
// half of the maximum is inside) or LABELMAP (8 or 16 bits). Labels are segment numbers. Frames may come in any order;
// what has no frame is empty; where segments overlap the higher number counts, and `remarks` has how often. `names` are
// the segments' labels, `meanings` those of their types' codes with laterality: "Upper lobe of lung Left". Pixels may
// be uncompressed, deflated with the file, or RLE. The contours of an RT Structure Set are filled (rt_structures.h).
// Reads nothing that identifies a patient. INVALID_ARGUMENT "name: ..." with problem and remedy, also for other kinds
// of DICOM objects; RESOURCE_EXHAUSTED for more than `max_voxels`. Thread-safe.
absl::StatusOr<LabelVolume> ParseDicomSegmentation(std::string_view name, std::string_view bytes,
                                                   std::size_t max_voxels = kMaxVoxels);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_DICOM_SEGMENTATION_H_
