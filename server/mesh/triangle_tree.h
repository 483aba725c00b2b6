// Nearest-point search on a triangle surface that may move: a tree of boxes whose shape is found once and whose boxes
// are fitted to where the vertices are.
#ifndef PHRENIC_SERVER_MESH_TRIANGLE_TREE_H_
#define PHRENIC_SERVER_MESH_TRIANGLE_TREE_H_

#include <Eigen/Geometry>
#include <limits>
#include <vector>

#include "server/mesh/mesh.h"

namespace phrenic {

// Weights of a, b and c that give the point of their triangle nearest to p; one that is 0 is exactly so. (C. Ericson,
// Real-Time Collision Detection, 2005, section 5.1.5.)
Eigen::Vector3d NearestWeights(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                               const Eigen::Vector3d& p);

// The point of a surface that is nearest to another point.
struct SurfacePoint {
  int triangle = -1;                                         // -1: none within reach
  Eigen::Vector3d weights;                                   // of the triangle's vertices; their sum is 1
  Eigen::Vector3d offset;                                    // from the point to the surface's [m]
  double squared = std::numeric_limits<double>::infinity();  // |offset|^2
  // (normal . offset) / |offset| of the triangle; positive where the point is behind the surface. On an edge or vertex
  // that triangles share, that triangle counts that faces the point most squarely (Huang et al., Volume Visualization
  // 2001).
  double facing = 0;
  bool on_rim = false;  // on an edge or vertex of the surface's border: neither in front nor behind
};

// The shape is immutable: any number of threads may ask. Neither fitting (into boxes of the right size) nor asking
// allocates.
class TriangleTree {
 public:
  using Boxes = std::vector<Eigen::AlignedBox3d>;

  TriangleTree() = default;
  TriangleTree(const ConstPoints& x, const Triangles& triangles);

  // The boxes for vertices at `x`.
  void Fit(const ConstPoints& x, Boxes& boxes) const;
  // The nearest point within `reach` [m] of the surface with vertices at `x`, which `boxes` fit.
  SurfacePoint Nearest(const ConstPoints& x, const Boxes& boxes, const Eigen::Vector3d& point, double reach) const;
  Eigen::Vector3i triangle(int t) const { return triangles_.col(t); }

 private:
  struct Node {
    int first, count;  // of its triangles; those of a node are consecutive
    int left = -1;     // its children are left and left + 1; -1: it is a leaf
  };
  void Split(int node, const Points& middles, std::vector<int>& order);
  void FindRims();
  void Try(const ConstPoints& x, const Eigen::Vector3d& point, int triangle, SurfacePoint& best) const;

  Triangles triangles_;  // in the tree's order
  std::vector<Node> nodes_;
  std::vector<Eigen::Vector3i> open_edge_;  // of each triangle: 1 where the edge opposite that vertex is on the border
  std::vector<bool> open_vertex_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MESH_TRIANGLE_TREE_H_
