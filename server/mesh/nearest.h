// Nearest-vertex search over a fixed point set, by nanoflann's k-d tree. For the nearest point of a surface see
// triangle_tree.h.
#ifndef PHRENIC_SERVER_MESH_NEAREST_H_
#define PHRENIC_SERVER_MESH_NEAREST_H_

#include <limits>
#include <memory>
#include <vector>

#include "server/mesh/mesh.h"

namespace phrenic {

struct Neighbour {
  int vertex = -1;      // -1 if there is none
  double distance = 0;  // [m]
};

// Immutable after construction; thread-safe. Keeps its own copy of the points.
class NearestSearch {
 public:
  // Requires: at least one point.
  explicit NearestSearch(Points points);
  ~NearestSearch();
  NearestSearch(const NearestSearch&) = delete;
  NearestSearch& operator=(const NearestSearch&) = delete;

  // Returns the nearest vertex; ties go to the lowest index, so that the result does not depend on the tree. Returns
  // vertex -1 at infinite distance if no vertex is within `reach` [m]. A small reach makes the search faster.
  Neighbour Nearest(const Eigen::Vector3d& point, double reach = std::numeric_limits<double>::infinity()) const;
  // Returns every vertex within `radius` [m], boundary included, nearest first, ties by index. Empty if the radius is
  // negative or NaN.
  std::vector<Neighbour> Within(const Eigen::Vector3d& point, double radius) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MESH_NEAREST_H_
