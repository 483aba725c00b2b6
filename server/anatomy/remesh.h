// Even triangles for the closed surface of a field.
#ifndef PHRENIC_SERVER_ANATOMY_REMESH_H_
#define PHRENIC_SERVER_ANATOMY_REMESH_H_

#include "server/anatomy/implicit_surface.h"

namespace phrenic::anatomy {

// Collapses edges shorter than the aim, makes the rest Delaunay and relaxes the vertices along the surface, some rounds
// (after Botsch and Kobbelt, Symposium on Geometry Processing 2004, without splits: the input is finer than the aim).
// Keeps the topology. Deterministic.
Mesh Remesh(const Field& field, const Mesh& fine, double edge_length);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_REMESH_H_
