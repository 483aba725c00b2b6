// The motion of lung tissue as a field on a regular grid, for files.
#ifndef PHRENIC_SERVER_MECHANICS_LUNGS_LUNG_FIELD_H_
#define PHRENIC_SERVER_MECHANICS_LUNGS_LUNG_FIELD_H_

#include <cstdint>
#include <span>
#include <vector>

#include "absl/status/statusor.h"
#include "server/mechanics/lungs/lung_tissue.h"

namespace phrenic {

// One lung between two moments.
struct LungMotion {
  LungTissue tissue;  // at rest
  Points nodes;       // displacement of the grid's nodes from the first moment to the second, 3 x nodes [m]
};

// Values at the points of a grid, x fastest, where the lungs are at rest; 0 outside them.
struct LungField {
  Eigen::Vector3i size = Eigen::Vector3i::Zero();
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  // of the first point [m]
  double spacing = 0;                                // [m]
  Points displacement;                               // 3 x points [m]
  Eigen::VectorXd ventilation;                       // div u: volume gained per volume at rest [1]
  std::vector<std::uint8_t> lung;                    // 1 + the index of the lung that holds the point; 0: none

  Eigen::Vector3d PointAt(Eigen::Index index) const;
};

inline constexpr double kMostFieldPoints = 2e7;

// Samples the lungs every `spacing` [m], from a border of one spacing around them. INVALID_ARGUMENT if there is no
// lung, or the grid would have more than kMostFieldPoints.
absl::StatusOr<LungField> SampleLungs(std::span<const LungMotion> lungs, double spacing);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_LUNGS_LUNG_FIELD_H_
