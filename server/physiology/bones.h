// How ribs, sternum and lungs move between two moments.
#ifndef PHRENIC_SERVER_PHYSIOLOGY_BONES_H_
#define PHRENIC_SERVER_PHYSIOLOGY_BONES_H_

#include <vector>

#include "server/physiology/parts.h"

namespace phrenic::physiology {

// Returns the mean displacement of the body of the sternum [m]; kNone without one.
Eigen::Vector3d SternumShift(const Model& model, const Parts& parts, const State& from, const State& to);

// Returns the mean outward displacement of the outermost points of ribs 7 to 10 from rest [m]; kNone without ribs.
double LowerRibShift(const Model& model, const Parts& parts, const State& state);
// Returns the same of ribs 4 to 7 of one side.
double MiddleRibShift(const Model& model, const Parts& parts, const State& state, v1::Side side);

// Points of the lungs at rest [m], and how far each moves down [m].
struct LoweredPoints {
  std::vector<Eigen::Vector3d> rest;
  std::vector<double> by;
};
// Returns the vertices of the lungs' surfaces, and how far they move down between two moments; empty without lungs.
LoweredPoints LoweredLungs(const Model& model, const Parts& parts, const State& from, const State& to);

// Caudal displacement of the lungs between two moments; all kNone without points.
struct LungShift {
  double least = kNone;            // of all points but a twentieth [m]
  double apex = kNone;             // mean of the uppermost tenth of the height [m]
  double base = kNone;             // mean of the lowest tenth [m]
  double back_over_front = kNone;  // of the posterior and the anterior third of the lower half [1]
};
LungShift ShiftOf(const LoweredPoints& lungs);

// Returns the volume of the lungs' surfaces [m^3]; kNone without lungs.
double LungSurfaceVolume(const Model& model, const Parts& parts, const State& state);

}  // namespace phrenic::physiology

#endif  // PHRENIC_SERVER_PHYSIOLOGY_BONES_H_
