// Nearest-point search on a deforming triangle surface from a triangle that is near already: without boxes to refit, at
// the cost of the triangles on the way.
#ifndef PHRENIC_SERVER_MESH_SURFACE_WALK_H_
#define PHRENIC_SERVER_MESH_SURFACE_WALK_H_

#include <vector>

#include "server/mesh/triangle_tree.h"

namespace phrenic {

// Refers to the tree. Immutable; thread-safe; Nearest does not allocate.
class SurfaceWalk {
 public:
  explicit SurfaceWalk(const TriangleTree& tree);

  // Walks from triangle `from`, in the tree's order, to the triangle nearest to `point` of those that share a vertex
  // with it, as long as that is nearer. Returns the point where it ends, a local minimum of the distance: the nearest
  // point of the surface if `from` is near it.
  SurfacePoint Nearest(const ConstPoints& x, const Eigen::Vector3d& point, int from) const;

 private:
  const TriangleTree& tree_;
  std::vector<int> first_, neighbours_;  // those of triangle t: first_[t] up to first_[t + 1]
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MESH_SURFACE_WALK_H_
