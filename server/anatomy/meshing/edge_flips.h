// Intrinsic Delaunay triangulation of a surface by edge flips.
#ifndef PHRENIC_SERVER_ANATOMY_MESHING_EDGE_FLIPS_H_
#define PHRENIC_SERVER_ANATOMY_MESHING_EDGE_FLIPS_H_

#include <Eigen/Core>
#include <vector>

#include "server/mesh/mesh.h"

namespace phrenic::anatomy {

// Flips interior edges until each is Delaunay on the surface (its two opposite angles, measured in `points`, sum to at
// most pi) or its flip would make a triangle clockwise in `plane`. At most 30 passes. Deterministic.
void FlipToDelaunay(const std::vector<Eigen::Vector2d>& plane, const std::vector<Eigen::Vector3d>& points,
                    Triangles& triangles);

// The same for a closed surface in space. A flip must keep both triangles within 60 degrees of their mean normal and
// must not create an existing edge.
void FlipToDelaunay(const std::vector<Eigen::Vector3d>& points, Triangles& triangles);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_MESHING_EDGE_FLIPS_H_
