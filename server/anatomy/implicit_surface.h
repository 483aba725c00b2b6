// Closed surfaces of smooth fields: where a field that is negative inside is zero.
#ifndef PHRENIC_SERVER_ANATOMY_IMPLICIT_SURFACE_H_
#define PHRENIC_SERVER_ANATOMY_IMPLICIT_SURFACE_H_

#include <Eigen/Core>
#include <functional>

#include "server/mesh/mesh.h"

namespace phrenic::anatomy {

using Field = std::function<double(const Eigen::Vector3d&)>;  // about the signed distance [mm], negative inside

struct Box {
  Eigen::Vector3d low, high;  // the surface must lie inside
};

// Marching tetrahedra on cubes of side `cell` cut into six (Payne and Toga, IEEE CG&A 1990;10(5):33), which has no
// ambiguous case: the result is a closed manifold, outward, with cut points kept off the grid's corners; its largest
// component only. Triangles are of any shape; Remesh makes them even.
Mesh Polygonise(const Field& field, const Box& box, double cell);

// Polygonised at 0.6 edge lengths, or at `detail` where that is finer, so that no part of the shape is lost; then
// remeshed to near-uniform triangles of the edge length.
Mesh ImplicitSurface(const Field& field, const Box& box, double edge_length, double detail);

// Polynomial smooth minimum of two distances, rounded over the width k (Quilez).
double SmoothMin(double a, double b, double k);

// Distance to the capsule from a to b whose radius goes from ra to rb.
double Capsule(const Eigen::Vector3d& x, const Eigen::Vector3d& a, const Eigen::Vector3d& b, double ra, double rb);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_IMPLICIT_SURFACE_H_
