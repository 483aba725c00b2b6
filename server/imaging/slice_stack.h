// Arranges parallel slices, which may come in any order and several at one place, to the slices of a volume.
#ifndef PHRENIC_SERVER_IMAGING_SLICE_STACK_H_
#define PHRENIC_SERVER_IMAGING_SLICE_STACK_H_

#include <Eigen/Geometry>
#include <vector>

#include "absl/status/statusor.h"

namespace phrenic::imaging {

// What all slices share [mm, LPS].
struct SlicePlane {
  Eigen::Vector3d along_row = Eigen::Vector3d::UnitX();     // from a voxel to the next one in its row
  Eigen::Vector3d along_column = Eigen::Vector3d::UnitY();  // from a voxel to the one in the next row
};

struct SliceStack {
  Eigen::Affine3d to_patient;  // (column, row, slice) -> LPS [mm]; right-handed
  int slices = 0;              // including those between the first and the last without a position
  std::vector<int> slice_of;   // slice of each position
};

// Returns the stack of the slices whose first voxels are at `positions` [mm, LPS]. Positions within 0.02 mm along the
// normal are one slice. The distance of slices is the smallest gap between neighbours if all gaps are multiples of it,
// else `stated` [mm] (0: not stated) if they are multiples of that, or if there is a single slice. The step from slice
// to slice may be oblique to the plane (a tilted gantry). INVALID_ARGUMENT with problem and remedy if the slices are
// not equidistant, are shifted against each other by more than a tenth of a voxel, or violate kVoxelFrameRule.
// Requires: at least one position; an orthogonal plane. Thread-safe.
absl::StatusOr<SliceStack> StackSlices(const SlicePlane& plane, const std::vector<Eigen::Vector3d>& positions,
                                       double stated);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_SLICE_STACK_H_
