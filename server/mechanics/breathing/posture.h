// Postures, and the direction of gravity in each of them.
#ifndef PHRENIC_SERVER_MECHANICS_BREATHING_POSTURE_H_
#define PHRENIC_SERVER_MECHANICS_BREATHING_POSTURE_H_

#include <Eigen/Core>
#include <array>

#include "phrenic/v1/parameters.pb.h"

namespace phrenic {

// Every posture but POSTURE_UNSPECIFIED.
inline constexpr std::array<v1::Posture, 5> kPostures = {v1::POSTURE_SUPINE, v1::POSTURE_UPRIGHT, v1::POSTURE_PRONE,
                                                         v1::POSTURE_RIGHT_SIDE, v1::POSTURE_LEFT_SIDE};

// Returns a vector along gravity in a posture, in LPS axes, as long as `supine`, the one in the supine
// posture. Pure function.
inline Eigen::Vector3d DownIn(v1::Posture posture, const Eigen::Vector3d& supine) {
  switch (posture) {
    case v1::POSTURE_UPRIGHT:
      return -supine.norm() * Eigen::Vector3d::UnitZ();
    case v1::POSTURE_PRONE:
      return -supine;
    case v1::POSTURE_RIGHT_SIDE:
      return -supine.norm() * Eigen::Vector3d::UnitX();
    case v1::POSTURE_LEFT_SIDE:
      return supine.norm() * Eigen::Vector3d::UnitX();
    default:
      return supine;
  }
}

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_BREATHING_POSTURE_H_
