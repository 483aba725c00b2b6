// Closed tubes of varying elliptic cross-section along a smooth curve: ribs, cartilages, the plates of the sternum.
// Lengths in one unit, here millimetres. Thread-safe.
#ifndef PHRENIC_SERVER_ANATOMY_TUBE_H_
#define PHRENIC_SERVER_ANATOMY_TUBE_H_

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

struct TubeSection {
  double half_broad, half_thin;  // semi-axes [mm]
  Eigen::Vector3d thin;          // direction of the thin axis; normalised and made perpendicular to the curve
};

// The cross-section at the relative arc length s in [0, 1], at the curve point `centre`.
using SectionAt = std::function<TubeSection(double s, const Eigen::Vector3d& centre)>;

// Returns a tube with rounded ends, built of rings with equal vertex counts, each offset by half a step from the
// previous one. Edges are about `edge_length` long; at least six vertices per ring and three rings. Closed, facing
// outwards, genus 0.
Mesh Tube(const Curve& through, const SectionAt& section, double edge_length);

// Returns the mirror image in x = 0, with the winding reversed so that it faces outwards.
Mesh Mirrored(Mesh mesh);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_TUBE_H_
