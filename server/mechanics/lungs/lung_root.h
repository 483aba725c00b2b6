// The root of a lung: at the hilum bronchi and vessels enter it and bind it to the mediastinum. Elsewhere it slides.
//
// In the lung's box, with eta posterior in -1..1 and zeta 0 at the base, 1 at the apex, the hilum is what faces the
// midline of the ellipse about (kHilumDepth, kHilumHeight). It lies opposite T5 to T7, behind the middle of the depth
// (Gray's Anatomy, 41st edition, chapter 54). Heights and depth are those of the generated thorax, where T5 to T7 are
// at zeta = 0.39 to 0.70 and the main bronchi end at eta = 0.2; the half depth, a root 40 mm deep, is chosen.
//
// The pulmonary ligament below the hilum is left out: it is a loose fold that leaves the lower veins room.
#ifndef PHRENIC_SERVER_MECHANICS_LUNGS_LUNG_ROOT_H_
#define PHRENIC_SERVER_MECHANICS_LUNGS_LUNG_ROOT_H_

#include <Eigen/Geometry>

namespace phrenic {

inline constexpr double kHilumHeight = 0.54, kHilumHalfHeight = 0.16;  // zeta [1]
inline constexpr double kHilumDepth = 0.2, kHilumHalfDepth = 0.25;     // eta [1]

// Thread-safe for reading.
struct LungRoot {
  double outwards = 0;      // +1 of a left lung, -1 of a right one; 0: the lung has no root
  Eigen::AlignedBox3d box;  // of the whole lung, also of a lobe's [m]

  // True if a point of the surface with this outward unit normal belongs to the root.
  bool Holds(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_LUNGS_LUNG_ROOT_H_
