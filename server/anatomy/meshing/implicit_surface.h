// Closed triangle surfaces of implicit functions: the zero level set of a field that is negative inside. Lengths are in
// the caller's unit, here millimetres. Thread-safe.
#ifndef PHRENIC_SERVER_ANATOMY_MESHING_IMPLICIT_SURFACE_H_
#define PHRENIC_SERVER_ANATOMY_MESHING_IMPLICIT_SURFACE_H_

#include <Eigen/Core>

#include "server/anatomy/meshing/field.h"
#include "server/mesh/mesh.h"

namespace phrenic::anatomy {

struct Box {
  Eigen::Vector3d low, high;  // corners; the surface must lie inside
};

// Polygonises by marching tetrahedra on cubes of side `cell`, each split into six (Payne and Toga, IEEE CG&A
// 1990;10(5):33), which has no ambiguous case. Returns the largest connected component: a closed manifold, facing
// outwards. Triangle quality is poor; Remesh improves it.
Mesh Polygonise(const Field& field, const Box& box, double cell);

// Polygonises with cells of 0.6 edge lengths, or of `detail` [mm], the thinnest feature, if that is finer; then
// remeshes to near-uniform triangles of `edge_length` [mm].
Mesh ImplicitSurface(const Field& field, const Box& box, double edge_length, double detail);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_MESHING_IMPLICIT_SURFACE_H_
