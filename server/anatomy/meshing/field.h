// Implicit functions: fields that are negative inside a shape, their blending, and primitives. Pure functions,
// thread-safe.
#ifndef PHRENIC_SERVER_ANATOMY_MESHING_FIELD_H_
#define PHRENIC_SERVER_ANATOMY_MESHING_FIELD_H_

#include <Eigen/Core>
#include <functional>

namespace phrenic::anatomy {

using Field = std::function<double(const Eigen::Vector3d&)>;  // approximate signed distance [mm], negative inside

// Returns the polynomial smooth minimum of two distances, blended over the width k (Quilez): min(a, b) - h^2 k / 4 with
// h = max(k - |a - b|, 0) / k. It unites two shapes.
double SmoothMin(double a, double b, double k);

// Returns the smooth maximum of two distances in the same way. It intersects two shapes.
double SmoothMax(double a, double b, double k);

// Returns the approximate signed distance to the tapered capsule from a (radius ra) to b (radius rb).
double Capsule(const Eigen::Vector3d& x, const Eigen::Vector3d& a, const Eigen::Vector3d& b, double ra, double rb);

// Returns the approximate signed distance to the ellipsoid with these semi-axes along x, y, z.
double Ellipsoid(const Eigen::Vector3d& x, const Eigen::Vector3d& centre, const Eigen::Vector3d& radii);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_MESHING_FIELD_H_
