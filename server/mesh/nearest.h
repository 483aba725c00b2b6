// Nearest-vertex search over a fixed point set, by a bounding volume hierarchy (box_tree.h). For the nearest point of a
// surface see triangle_tree.h.
#ifndef PHRENIC_SERVER_MESH_NEAREST_H_
#define PHRENIC_SERVER_MESH_NEAREST_H_

#include <limits>
#include <vector>

#include "server/mesh/box_tree.h"
#include "server/mesh/mesh.h"

namespace phrenic {

struct Neighbour {
  int vertex = -1;      // -1 if there is none
  double distance = 0;  // [m]
};

// Immutable after construction; thread-safe. Keeps its own copy of the points.
class NearestSearch {
 public:
  // `points`: 3 x n, one column per vertex [m].
  explicit NearestSearch(const Points& points);

  // Returns the nearest vertex; ties go to the lowest index, so that the result does not depend on the tree. Returns
  // vertex -1 at infinite distance if no vertex is within `reach` [m]. A small reach makes the search faster.
  Neighbour Nearest(const Eigen::Vector3d& point, double reach = std::numeric_limits<double>::infinity()) const;
  // Returns every vertex within `radius` [m], boundary included, nearest first, ties by index. Empty if the radius is
  // negative or NaN.
  std::vector<Neighbour> Within(const Eigen::Vector3d& point, double radius) const;

 private:
  BoxTree tree_;
  BoxTree::Boxes boxes_;
  Points points_;  // in the tree's order
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MESH_NEAREST_H_
