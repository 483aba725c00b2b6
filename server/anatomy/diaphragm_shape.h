// The middle surface of the diaphragm as one smooth map from a plane, its border, its openings and its tendon.
//
// The plane point p = d (cos, sin) lies on the meridian of that azimuth (+x left, +y back). With rho(d) = d - 0.1365
// d^3 below d = 1.3, phi = pi rho^m / 2 (up to pi / 2), q = (sin phi)^(1/m) times the azimuth's unit vector, m = 2.6:
//   z = fold + (top(q) - fold) cos phi on the domes, z = fold - m pi / 2 (top - fold)(rho - 1) on the wall below the
//   fold, (x, y) = the cage's cross-section at that z, at q.
// So each meridian is a superellipse that goes over into the vertical zone of apposition with a continuous tangent.
//
// Sources: domes, saddle, rim and opening levels after the project's physiology notes (right dome at T8, left 15-25 mm
// lower, saddle 10-15 mm lower, caval opening T8 in the tendon, oesophageal T10 in the muscle, aortic T12 behind the
// sheet, right crus to L3, left to L2). All lengths in millimetres; pure functions, any thread.
#ifndef PHRENIC_SERVER_ANATOMY_DIAPHRAGM_SHAPE_H_
#define PHRENIC_SERVER_ANATOMY_DIAPHRAGM_SHAPE_H_

#include <Eigen/Core>
#include <vector>

namespace phrenic::anatomy {

using PlaneLoop = std::vector<Eigen::Vector2d>;  // closed: the last point joins the first

Eigen::Vector3d DiaphragmPoint(const Eigen::Vector2d& p);

// Unit normal towards the thorax: upwards on the domes, outwards on the wall.
Eigen::Vector3d DiaphragmNormal(const Eigen::Vector2d& p);

// Height of the dome over disc coordinates q of the cage, |q| <= 1: what the lungs rest on.
double DomeHeight(const Eigen::Vector2d& q);

// How far the sheet keeps from the ribs' centrelines [mm].
inline constexpr double kDiaphragmInset = 8;

// Densely sampled: the border (anticlockwise seen from above) and the two openings.
PlaneLoop DiaphragmRim();
PlaneLoop CavalOpening();
PlaneLoop OesophagealOpening();

// The trefoil tendon around the caval opening.
bool InTendon(const Eigen::Vector2d& p);

// In the pillar of that side, below the arcuate ligaments.
bool InRightCrus(const Eigen::Vector2d& p);
bool InLeftCrus(const Eigen::Vector2d& p);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_DIAPHRAGM_SHAPE_H_
