// Nearest-point search on a deforming triangle surface by a bounding volume hierarchy (box_tree.h), whose boxes are
// refitted to the vertices' positions.
#ifndef PHRENIC_SERVER_MESH_TRIANGLE_TREE_H_
#define PHRENIC_SERVER_MESH_TRIANGLE_TREE_H_

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "server/mesh/box_tree.h"
#include "server/mesh/mesh.h"

namespace phrenic {

// Returns the barycentric weights of the point of triangle a b c nearest to p. On an edge or a vertex the other weights
// are exactly 0. (C. Ericson, Real-Time Collision Detection, 2005, section 5.1.5.)
Eigen::Vector3d NearestWeights(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                               const Eigen::Vector3d& p);

// The point of a surface nearest to a query point.
struct SurfacePoint {
  int triangle = -1;                                         // -1 if none is within reach
  Eigen::Vector3d weights;                                   // barycentric, of the triangle's vertices; sum 1
  Eigen::Vector3d offset;                                    // from the query to the surface point [m]
  double squared = std::numeric_limits<double>::infinity();  // |offset|^2 [m^2]
  // normal . offset / (|normal| |offset|) of the triangle, in [-1, 1]; positive if the query is behind the surface. If
  // triangles tie at a shared edge or vertex, the one with the largest |facing| is taken, which gives the right sign
  // (Huang et al., Volume Visualization 2001).
  double facing = 0;
  bool on_boundary = false;  // on a boundary edge or vertex, where the sign of `facing` means nothing
};

// Immutable after construction; thread-safe. The caller keeps the boxes. Fit (into boxes of the right size) and Nearest
// do not allocate.
class TriangleTree {
 public:
  using Boxes = BoxTree::Boxes;

  TriangleTree() = default;
  TriangleTree(const ConstPoints& x, const Triangles& triangles);

  // Refits the boxes to vertices at `x` (3 x n) [m]; resizes `boxes` if needed.
  void Fit(const ConstPoints& x, Boxes& boxes) const;
  // Returns the nearest point within `reach` [m]. Requires: `boxes` are fitted to `x`.
  SurfacePoint Nearest(const ConstPoints& x, const Boxes& boxes, const Eigen::Vector3d& point, double reach) const;
  // Replaces `best` by the nearest point of a triangle, if that is nearer, or as near and facing more.
  void Try(const ConstPoints& x, const Eigen::Vector3d& point, int triangle, SurfacePoint& best) const;
  // The triangles are in the tree's order.
  Eigen::Vector3i triangle(int t) const { return triangles_.col(t); }
  const Triangles& triangles() const { return triangles_; }

 private:
  void FindBoundary();

  BoxTree tree_;
  Triangles triangles_;                         // in the tree's order
  std::vector<Eigen::Vector3i> boundary_edge_;  // per triangle: 1 if the edge opposite that corner is a boundary edge
  std::vector<bool> boundary_vertex_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MESH_TRIANGLE_TREE_H_
