// Reads where the frames of a DICOM Segmentation lie: its functional groups (PS3.3, C.7.6.16 and C.8.20).
#ifndef PHRENIC_SERVER_IMAGING_DICOM_FRAMES_H_
#define PHRENIC_SERVER_IMAGING_DICOM_FRAMES_H_

#include <Eigen/Core>
#include <vector>

#include "absl/status/statusor.h"
#include "server/imaging/slice_stack.h"

class DcmItem;

namespace phrenic::imaging {

struct DicomFrames {
  SlicePlane plane;                        // of all frames
  double spacing = 0;                      // between slices, as stated [mm]; 0 if it is not
  std::vector<Eigen::Vector3d> positions;  // of each frame's first voxel [mm, LPS]
  std::vector<int> segments;               // each frame's segment number; 0 if `label_map`
};

// Reads the frames of a data set. A frame's own functional group takes precedence over the shared one. `label_map`: the
// frames have no segment numbers, because their pixels are such numbers. INVALID_ARGUMENT with frame, attribute and
// remedy if one is missing or invalid, or if frames differ in orientation or pixel spacing.
absl::StatusOr<DicomFrames> ReadDicomFrames(DcmItem& dataset, int frames, bool label_map);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_DICOM_FRAMES_H_
