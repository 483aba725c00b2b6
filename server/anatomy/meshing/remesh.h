// Isotropic remeshing of the closed surface of an implicit function.
#ifndef PHRENIC_SERVER_ANATOMY_MESHING_REMESH_H_
#define PHRENIC_SERVER_ANATOMY_MESHING_REMESH_H_

#include "server/anatomy/meshing/field.h"
#include "server/mesh/mesh.h"

namespace phrenic::anatomy {

// Repeats edge collapse, Delaunay flips and tangential relaxation with projection onto field = 0, six rounds (after
// Botsch and Kobbelt, Symposium on Geometry Processing 2004, without edge splits). Requires: the edges of `fine` are
// shorter than `edge_length`, in the field's unit. Keeps the topology. Deterministic.
Mesh Remesh(const Field& field, const Mesh& fine, double edge_length);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_MESHING_REMESH_H_
