// How ribs, sternum and lungs move between two moments.
#ifndef PHRENIC_SERVER_PHYSIOLOGY_BONES_H_
#define PHRENIC_SERVER_PHYSIOLOGY_BONES_H_

#include "server/physiology/parts.h"

namespace phrenic::physiology {

// Returns the mean displacement of the body of the sternum [m]; kNone without one.
Eigen::Vector3d SternumShift(const Model& model, const Parts& parts, const State& from, const State& to);

// Returns the mean outward displacement of the outermost points of ribs 7 to 10 from rest [m]; kNone without ribs.
double LowerRibShift(const Model& model, const Parts& parts, const State& state);

// Caudal displacement of the surface of the lungs between two moments; all kNone without lungs.
struct LungShift {
  double least = kNone;            // of all but a twentieth of it [m]
  double apex = kNone;             // mean of the uppermost tenth of the height [m]
  double base = kNone;             // mean of the lowest tenth [m]
  double back_over_front = kNone;  // of the posterior and the anterior third of the lower half [1]
};
LungShift LungShiftBetween(const Model& model, const Parts& parts, const State& from, const State& to);

// Returns the volume of the lungs' surfaces [m^3]; kNone without lungs.
double LungSurfaceVolume(const Model& model, const Parts& parts, const State& state);

}  // namespace phrenic::physiology

#endif  // PHRENIC_SERVER_PHYSIOLOGY_BONES_H_
