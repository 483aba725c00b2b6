// Closed tubes of varying flattened cross-section along a smooth curve: ribs, cartilages and vessels. Lengths in one
// unit, here millimetres. Thread-safe.
#ifndef PHRENIC_SERVER_ANATOMY_MESHING_TUBE_H_
#define PHRENIC_SERVER_ANATOMY_MESHING_TUBE_H_

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "server/mesh/mesh.h"

namespace phrenic::anatomy {

using Curve = std::vector<Eigen::Vector3d>;

// Returns the centripetal Catmull-Rom spline through the points (at least two), sampled at `count` >= 2 equal arc
// lengths.
Curve SmoothCurve(const Curve& through, int count);

// Returns the length of the polyline.
double Length(const Curve& curve);

// A cross-section: with a = 0 to 2 pi, the point at
//   u = half_broad c, v = (half_thin (1 - taper c) + bulge max(0, s)) s,
// c and s the cosine and sine of a, their magnitudes raised to the power 1 - flatness. u is the coordinate along
// `thin` x the direction of the curve, v along `thin`.
struct TubeSection {
  double half_broad, half_thin;  // semi-axes [mm]
  Eigen::Vector3d thin;          // direction of the thin axis; normalised and made perpendicular to the curve
  double flatness = 0;           // 0 is an ellipse, 1 a rectangle
  double taper = 0;              // makes the edge on the side of +u thinner, the other thicker
  double bulge = 0;              // thickens the side of +v [mm]
};

// The cross-section at the relative arc length s in [0, 1], at the curve point `centre`.
using SectionAt = std::function<TubeSection(double s, const Eigen::Vector3d& centre)>;

// How a tube ends: rounded off, or cut straight, so that another tube with the same section continues it.
enum class TubeEnd { kRound, kStraight };

struct TubeShape {
  Curve through;  // at least two points
  SectionAt section;
  TubeEnd first = TubeEnd::kRound, last = TubeEnd::kRound;
  Eigen::Vector3d start = Eigen::Vector3d::Zero();  // direction at the first point; that of the curve if zero
  double radius = 0;  // gives the number of vertices of a ring; the mean radius of the middle section if 0
};

// Returns a tube of rings with equal vertex counts, the vertices of all rings aligned, so that outlines are smooth:
// about 1.3 edge lengths between rings and 0.6 around them, at least ten vertices a ring. Closed, facing
// outwards, genus 0.
Mesh Tube(const TubeShape& shape, double edge_length);

// Returns the mirror image in x = 0, with the winding reversed so that it faces outwards.
Mesh Mirrored(Mesh mesh);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_MESHING_TUBE_H_
