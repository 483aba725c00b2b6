#include "server/imaging/label_volume.h"

#include <cmath>

namespace phrenic::imaging {

bool IsVoxelFrame(const Eigen::Affine3d& to_patient) {
  constexpr double kShortest = 0.05, kLongest = 50, kFarthest = 1e5;  // [mm]
  constexpr double kMostElongated = 20;                               // masks are padded by some of the longest edges
  const Eigen::Matrix3d axes = to_patient.linear();
  const double low = axes.colwise().norm().minCoeff(), high = axes.colwise().norm().maxCoeff();
  return axes.allFinite() && to_patient.translation().allFinite() && low >= kShortest && high <= kLongest &&
         high <= kMostElongated * low && to_patient.translation().norm() < kFarthest &&
         std::abs(axes.determinant()) > 0.1 * low * low * low;
}

}  // namespace phrenic::imaging
