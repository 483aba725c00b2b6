// CT numbers of tissues [HU], from the attenuation at 70 keV (fluoroscopy/attenuation.h: NIST Standard Reference
// Database 126, ICRU Reports 44 and 46), which is about the effective energy of a CT at 120 kV:
//   HU = 1000 (mu - mu_water) / mu_water.
#ifndef PHRENIC_SERVER_PHANTOM_HOUNSFIELD_H_
#define PHRENIC_SERVER_PHANTOM_HOUNSFIELD_H_

#include <Eigen/Core>

#include "server/fluoroscopy/attenuation.h"

namespace phrenic::phantom {

inline constexpr double kAirHounsfield = -1000;

// Returns the CT number of a tissue; of a rib that of its mean density, 1.4 g/cm^3. Requires: not kLung.
double HounsfieldOf(fluoroscopy::Tissue tissue);

// Returns the CT number of lung whose volume is `ratio` times that at the end of a quiet expiration: its tissue and
// blood, 0.3 g/cm^3 there, keep their mass, and what remains is air.
double LungHounsfield(double ratio);

// Returns the density of what a CT number is in lung [g/cm^3]: 1 + HU/1000, within 0.2 % of what LungHounsfield
// assumed.
inline double DensityOf(double hounsfield) { return 1 + hounsfield / 1000; }

// Returns a smooth, irregular number in [-1, 1] of a place [m], with a mean near 0 and a grain of about 10 mm:
// interpolated values at the points of a lattice. The same on every machine.
double GrainAt(const Eigen::Vector3d& place);

}  // namespace phrenic::phantom

#endif  // PHRENIC_SERVER_PHANTOM_HOUNSFIELD_H_
