// A label volume: one integer label per voxel, and the affine map from voxel indices to patient coordinates.
#ifndef PHRENIC_SERVER_IMAGING_LABEL_VOLUME_H_
#define PHRENIC_SERVER_IMAGING_LABEL_VOLUME_H_

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace phrenic::imaging {

using Label = std::uint16_t;  // 0 is background

// Limits of what files may declare.
inline constexpr int kMaxAlong = 32767;  // voxels along an axis
inline constexpr std::size_t kMaxVoxels = std::size_t{1} << 30;
inline constexpr const char* kVoxelFrameRule = "voxels of 0.05 to 50 mm, at most 20 times as long as wide";

// True if the map from voxel indices to patient coordinates [mm] is finite, invertible and obeys kVoxelFrameRule.
bool IsVoxelFrame(const Eigen::Affine3d& to_patient);

// Lengths in millimetres, as in images; frame LPS (+x left, +y posterior, +z superior).
struct LabelVolume {
  Eigen::Vector3i size = Eigen::Vector3i::Zero();            // voxels along i, j, k
  Eigen::Affine3d to_patient = Eigen::Affine3d::Identity();  // voxel index (i, j, k) -> voxel centre [mm]
  std::vector<Label> labels;                                 // i varies fastest
  std::map<int, std::string> names;                          // label -> name; empty if the file has none
  std::map<int, std::string> meanings;                       // label -> meaning of its code, a second name
  std::vector<std::string> remarks;                          // sentences about what the file contradicts or omits

  std::size_t Index(const Eigen::Vector3i& at) const {
    return (static_cast<std::size_t>(at.z()) * size.y() + at.y()) * size.x() + at.x();
  }
  bool Contains(const Eigen::Vector3i& at) const {
    return (at.array() >= 0).all() && (at.array() < size.array()).all();
  }
  // Returns the voxel spacing along i, j, k [mm].
  Eigen::Vector3d Spacing() const { return to_patient.linear().colwise().norm(); }
};

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_LABEL_VOLUME_H_
