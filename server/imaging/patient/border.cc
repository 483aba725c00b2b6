#include "server/imaging/patient/border.h"

#include <array>
#include <cmath>

namespace phrenic::imaging {
namespace {

// Returns the name of the direction of the patient that is nearest to this one (LPS).
std::string SideOf(const Eigen::Vector3d& direction) {
  constexpr std::array<std::array<const char*, 2>, 3> kSides = {
      {{"right", "left"}, {"front", "back"}, {"lower", "upper"}}};
  Eigen::Index axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  return kSides[static_cast<std::size_t>(axis)][direction[axis] > 0 ? 1 : 0];
}

}  // namespace

BorderCut LargestCut(const LabelVolume& volume, const Part& part) {
  const Mask& mask = part.mask;
  std::array<std::array<std::size_t, 2>, 3> counts = {};  // by axis and end
  for (int k = 0; k < mask.size.z(); ++k) {
    for (int j = 0; j < mask.size.y(); ++j) {
      for (int i = 0; i < mask.size.x(); ++i) {
        if (mask.inside[mask.Index(i, j, k)] == 0) continue;
        const Eigen::Vector3i at = mask.low + Eigen::Vector3i(i, j, k);
        if (!volume.Contains(at)) continue;
        for (int axis = 0; axis < 3; ++axis) {
          if (at[axis] == 0) ++counts[axis][0];
          if (at[axis] == volume.size[axis] - 1) ++counts[axis][1];
        }
      }
    }
  }
  BorderCut cut;
  const Eigen::Matrix3d axes = volume.to_patient.linear();  // [mm] a voxel
  for (int axis = 0; axis < 3; ++axis) {
    const double face = axes.col((axis + 1) % 3).cross(axes.col((axis + 2) % 3)).norm() / 100;  // [cm^2]
    for (int end = 0; end < 2; ++end) {
      const double area = face * static_cast<double>(counts[axis][end]);
      if (area > cut.area) cut = {area, SideOf((end == 0 ? -1.0 : 1.0) * axes.col(axis))};
    }
  }
  return cut;
}

}  // namespace phrenic::imaging
