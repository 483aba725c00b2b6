// The rays of a C-arm: where source and detector stand around the patient.
#ifndef PHRENIC_SERVER_FLUOROSCOPY_C_ARM_H_
#define PHRENIC_SERVER_FLUOROSCOPY_C_ARM_H_

#include <Eigen/Core>
#include <string_view>

#include "absl/status/statusor.h"

namespace phrenic::fluoroscopy {

inline constexpr double kIsocentreToDetector = 0.3;  // [m]
inline constexpr double kFieldHalfWidth = 0.21;      // of the picture, in the plane of the isocentre [m]

// Where a C-arm stands. Angles are those of the detector, as cardiologists name them.
struct CArm {
  double lao = 0;                   // to the patient's left [degrees]: positive LAO, negative RAO; 0 PA, 180 AP
  double cranial = 0;               // towards the head [degrees]; negative caudal
  double source_to_detector = 1.8;  // [m]; 0 for parallel rays
};

// How rays pass, in the patient frame [m]. The axes are unit vectors.
struct Projection {
  Eigen::Vector3d isocentre;
  Eigen::Vector3d right, up, to_detector;  // right and up in the picture, seen from the detector
  double source_distance = 0;              // from the source to the isocentre; 0 for parallel rays
  double half_width = kFieldHalfWidth;
};

Projection ProjectionOf(const CArm& arm, const Eigen::Vector3d& isocentre);

// True if pictures are shown mirrored: with the detector behind the patient, they are read as if facing the patient.
bool IsMirrored(const CArm& arm);

// Sets the angles of a view by its name: pa, ap, left-lateral, lao-30, rao-30. INVALID_ARGUMENT, with the names, for
// another one.
absl::StatusOr<CArm> NamedArm(std::string_view name);

}  // namespace phrenic::fluoroscopy

#endif  // PHRENIC_SERVER_FLUOROSCOPY_C_ARM_H_
