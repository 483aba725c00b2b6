// The spaces on both sides of the generated diaphragm, in which organs lie, as implicit functions: approximate signed
// distances [mm], negative inside. Pure functions, thread-safe.
#ifndef PHRENIC_SERVER_ANATOMY_SPACES_H_
#define PHRENIC_SERVER_ANATOMY_SPACES_H_

#include <Eigen/Core>

namespace phrenic::anatomy {

// Returns how far a point is from being within the chest wall, `inset` inside the ribs' centrelines.
double WithinCage(const Eigen::Vector3d& x, double inset);

// Returns the signed distance from the diaphragm's domes, positive above: the height difference, divided by the
// gradient's magnitude. Beside the fold, where the sheet leaves the chest wall, use WithinCage.
double AboveDome(const Eigen::Vector3d& x);

// Returns how far a point is from being below the diaphragm and inside its apposed zone, `gap` from the middle surface
// of the sheet.
double BelowDiaphragm(const Eigen::Vector3d& x, double gap);

// Returns how far a point is from being between the lungs, above the diaphragm by `gap` and within the chest wall.
double BetweenLungs(const Eigen::Vector3d& x, double gap);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_SPACES_H_
