// How the weight of a lung stretches its upper parts, and so makes them stiffer than the lower ones.
//
// A lung hangs in the pleura: the recoil pressure of its tissue rises by d g for each metre upwards, d its density. By
// the lungs' own recoil curve (thorax_pressures.h), tissue whose recoil is p above that of the lungs' middle has, per
// volume at the middle, the volume V = 1 + r (1 - exp(-e p)), r the room that is left above rest and e the recoil rate.
// Its bulk modulus V dp/dV over that at the middle is
//   m = V exp(s),  s = e p = e d g h   [1],
// h the height over the middle [m]; Young's modulus is proportional to it, Poisson's ratio the same. V is at least that
// of tissue without air.
//
// d = 300 kg/m^3, CT's -700 HU at the end of a supine expiration, as in server/fluoroscopy: 0.30 cmH2O/cm, where the
// pleural pressure was measured to rise by 0.2-0.3 (Agostoni, Physiol Rev 1972;52:57). That dependent lung is less
// inflated and takes more of a breath: Milic-Emili et al., J Appl Physiol 1966;21:749; by the weight of an elastic
// lung: West and Matthews, J Appl Physiol 1972;32:332.
#ifndef PHRENIC_SERVER_MECHANICS_LUNGS_LUNG_WEIGHT_H_
#define PHRENIC_SERVER_MECHANICS_LUNGS_LUNG_WEIGHT_H_

#include <Eigen/Core>

#include "phrenic/v1/forces.pb.h"

namespace phrenic {

inline constexpr double kLungDensity = 300;  // [kg/m^3]

// Thread-safe for reading.
struct LungWeight {
  Eigen::Vector3d rise = Eigen::Vector3d::Zero();    // gradient of s, upwards [1/m]; 0: a lung without weight
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  // of the lungs at rest [m]
  double room = 0;                                   // r [1]

  // Returns m at a point [m].
  double ModulusAt(const Eigen::Vector3d& point) const;
};

// Returns the weight of lungs of a volume at rest [m^3], air and tissue of both, about their middle. `down` is a unit
// vector, and every field of `lungs` is set. Pure function.
LungWeight WeightOfLungs(const v1::LungPair& lungs, double volume, const Eigen::Vector3d& middle,
                         const Eigen::Vector3d& down);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_LUNGS_LUNG_WEIGHT_H_
