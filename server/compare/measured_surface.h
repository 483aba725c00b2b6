// A triangle surface with a bounding-volume tree for distance queries.
#ifndef PHRENIC_SERVER_COMPARE_MEASURED_SURFACE_H_
#define PHRENIC_SERVER_COMPARE_MEASURED_SURFACE_H_

#include <limits>
#include <vector>

#include "server/mesh/triangle_tree.h"

namespace phrenic::compare {

// The vertices may move; the triangles stay the same. Const methods are thread-safe as long as no thread calls MoveTo.
class MeasuredSurface {
 public:
  // `x` are the vertices, 3 x n [m]; `triangles` their indices, 3 x m.
  MeasuredSurface(const ConstPoints& x, Triangles triangles);

  // Sets the vertices to `x`, 3 x n [m], and refits the tree.
  void MoveTo(const ConstPoints& x);

  bool empty() const { return triangles_.cols() == 0; }
  const Points& vertices() const { return x_; }
  // In the order of the tree: consecutive triangles are near each other.
  const Triangles& triangles() const { return triangles_; }
  // The vertices that a triangle uses, each once, ascending. Other vertices are not part of the surface.
  const std::vector<int>& used() const { return used_; }
  double Area() const;  // [m^2]

  // Returns the nearest point of the surface. `reach` [m] is an upper bound of the distance, which shortens the search;
  // a bound that is too small costs a second search. Requires: the surface is not empty.
  SurfacePoint Nearest(const Eigen::Vector3d& point, double reach = std::numeric_limits<double>::infinity()) const;
  // Returns the distance [m] from `point` to one triangle, numbered as in SurfacePoint.
  double DistanceTo(int triangle, const Eigen::Vector3d& point) const;

 private:
  Points x_;
  Triangles triangles_;
  std::vector<int> used_;
  TriangleTree tree_;
  TriangleTree::Boxes boxes_;
};

}  // namespace phrenic::compare

#endif  // PHRENIC_SERVER_COMPARE_MEASURED_SURFACE_H_
