// A volume of labels: a number a voxel, and where the voxels lie in the patient.
#ifndef PHRENIC_SERVER_IMAGING_LABEL_VOLUME_H_
#define PHRENIC_SERVER_IMAGING_LABEL_VOLUME_H_

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace phrenic::imaging {

using Label = std::uint16_t;  // 0: nothing

// Lengths in millimetres, as images give them; frame LPS (+x left, +y posterior, +z superior).
struct LabelVolume {
  Eigen::Vector3i size = Eigen::Vector3i::Zero();            // voxels along i, j, k
  Eigen::Affine3d to_patient = Eigen::Affine3d::Identity();  // of (i, j, k), the middle of a voxel, to [mm]
  std::vector<Label> labels;                                 // i runs fastest
  std::map<int, std::string> names;                          // of labels, where the file says them

  std::size_t Index(const Eigen::Vector3i& at) const {
    return (static_cast<std::size_t>(at.z()) * size.y() + at.y()) * size.x() + at.x();
  }
  bool Contains(const Eigen::Vector3i& at) const {
    return (at.array() >= 0).all() && (at.array() < size.array()).all();
  }
  // Lengths of the three edges of a voxel [mm].
  Eigen::Vector3d Spacing() const { return to_patient.linear().colwise().norm(); }
};

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_LABEL_VOLUME_H_
