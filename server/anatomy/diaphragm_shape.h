// The middle surface of the generated diaphragm as one smooth map from the plane, with its rim, openings and tendon.
//
// The plane point p = d (cos a, sin a) lies on the meridian of azimuth a (+x left, +y posterior). With
//   rho(d) = d - 0.1365 d^3 for d < 1.3, linear beyond; m = 2.6; phi = pi rho^m / 2, at most pi / 2;
//   q = (sin phi)^(1/m) (cos a, sin a):
//   domes: z = fold + (top(q) - fold) cos phi;
//   wall below the fold: z = fold - m pi / 2 (top - fold) (rho - 1);
//   (x, y) = the cage's cross-section at height z, at q.
// Each meridian is a superellipse that continues into the vertical zone of apposition with a continuous tangent.
//
// Sources: levels of domes, saddle, rim and openings from the project's physiology notes (right dome at T8, left 15-25
// mm lower, saddle 10-15 mm lower, caval opening at T8 in the tendon, oesophageal at T10 in the muscle, aortic at T12
// behind the sheet, right crus to L3, left to L2). Lengths in millimetres. Pure functions, thread-safe.
#ifndef PHRENIC_SERVER_ANATOMY_DIAPHRAGM_SHAPE_H_
#define PHRENIC_SERVER_ANATOMY_DIAPHRAGM_SHAPE_H_

#include <Eigen/Core>
#include <vector>

namespace phrenic::anatomy {

using PlaneLoop = std::vector<Eigen::Vector2d>;  // a closed polygon; the last point joins the first

// Returns the surface point of a plane point [mm].
Eigen::Vector3d DiaphragmPoint(const Eigen::Vector2d& p);

// Returns the unit normal towards the thorax: upwards on the domes, outwards on the wall.
Eigen::Vector3d DiaphragmNormal(const Eigen::Vector2d& p);

// Returns the height of the dome at disc coordinates q of the cage [mm]. Requires: |q| <= 1. The lungs' bases follow
// it.
double DomeHeight(const Eigen::Vector2d& q);

// Distance of the sheet from the ribs' centrelines [mm].
inline constexpr double kDiaphragmInset = 8;

// Return densely sampled loops in the plane: the rim, counter-clockwise seen from above, and the two openings.
PlaneLoop DiaphragmRim();
PlaneLoop CavalOpening();
PlaneLoop OesophagealOpening();

// Returns how far a point of the disc is outside of the three leaves of the central tendon, in disc coordinates;
// negative inside.
double OutsideLeaves(const Eigen::Vector2d& q);

// True in the trefoil central tendon, which contains the caval opening.
bool InTendon(const Eigen::Vector2d& p);

// True in the crus of that side, below the arcuate ligaments.
bool InRightCrus(const Eigen::Vector2d& p);
bool InLeftCrus(const Eigen::Vector2d& p);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_DIAPHRAGM_SHAPE_H_
