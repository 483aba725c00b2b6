// The motions of a lung's surroundings of which a person's breath is made: a few shapes d(x) on the surface, each with
// one amplitude [m].
//
// With xi lateral and eta posterior in -1..1 and zeta 0 at the base, 1 at the apex, over the lung's box, and smooth
// weights of the base, the costal and the medial side by the normal (they add to 1 everywhere):
//   piston -z, tilts -eta z and -xi z, dome -(eta^2 - 0.33) z on the base; pump -y (1 - eta)/2, low pump that times
//   (1 - zeta), back +y, apex -z clip((zeta - 0.6)/0.4, 0, 1) on the costal side; mediastinum towards the middle, and
//   its tilt times eta, on the medial side.
// Source: ../shared/motion.md, chosen on ten people's CT and checked on others.
#ifndef PHRENIC_SERVER_MECHANICS_LUNGS_BOUNDARY_MODES_H_
#define PHRENIC_SERVER_MECHANICS_LUNGS_BOUNDARY_MODES_H_

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "server/mechanics/lungs/lung_tissue.h"

namespace phrenic {

// A point of a lung's surface.
struct BoundaryPlace {
  double xi, eta, zeta;
  double base, costal, medial;  // weights
  double outwards;              // x of the lateral direction: +1 left, -1 right
};

// Requires: outwards is +1 for a left lung and -1 for a right one.
BoundaryPlace PlaceOf(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, const Eigen::AlignedBox3d& box,
                      double outwards);

struct BoundaryMode {
  const char* name;  // "tilt-front-back"
  const char* what;
  Eigen::Vector3d (*displacement)(const BoundaryPlace&);  // per amplitude
};

// Their indices.
enum BoundaryModeIndex : int {
  kPiston,
  kTiltFrontBack,
  kTiltLeftRight,
  kPump,
  kApex,
  kMediastinum,
  kMediastinumTilt,
  kBack,
  kLowPump,
  kDome
};

// Returns all of them; they live as long as the program.
std::span<const BoundaryMode> BoundaryModes();

// Returns the displacement of the nodes of a lung's grid (3 x nodes) per amplitude of the mode [1]: 4 ms.
Points ResponseTo(const BoundaryMode& mode, const LungTissue& tissue, double outwards);

// A number that is fitted: the amplitude of a mode in both lungs, or in one.
struct Amplitude {
  int mode;  // in BoundaryModes()
  bool right, left;

  std::string Name() const;  // "piston-right", "pump"
};

// Returns the 8 or 12 numbers of a breath. Requires: `count` is 8 or 12.
std::vector<Amplitude> BreathAmplitudes(int count);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_LUNGS_BOUNDARY_MODES_H_
