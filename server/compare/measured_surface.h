// A triangle surface that distances are measured from and to.
#ifndef PHRENIC_SERVER_COMPARE_MEASURED_SURFACE_H_
#define PHRENIC_SERVER_COMPARE_MEASURED_SURFACE_H_

#include <limits>
#include <vector>

#include "server/mesh/triangle_tree.h"

namespace phrenic::compare {

// May move, with the same triangles. Any number of threads may ask while none moves it.
class MeasuredSurface {
 public:
  MeasuredSurface(const ConstPoints& x, Triangles triangles);

  // The vertices go to `x`, 3 x n [m].
  void MoveTo(const ConstPoints& x);

  bool empty() const { return triangles_.cols() == 0; }
  const Points& vertices() const { return x_; }
  // In an order in which neighbours are near each other.
  const Triangles& triangles() const { return triangles_; }
  // The vertices that a triangle has, each once, in order: others are no part of the surface.
  const std::vector<int>& used() const { return used_; }
  double Area() const;  // [m^2]

  // The nearest point of the surface, which is not empty. `reach` [m] is known to be no less than the distance, and
  // spares the search what is farther.
  SurfacePoint Nearest(const Eigen::Vector3d& point, double reach = std::numeric_limits<double>::infinity()) const;
  // The distance [m] to one triangle, numbered as in SurfacePoint.
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
