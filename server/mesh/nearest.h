// Nearest-vertex search over a point set (a k-d tree by nanoflann).
#ifndef PHRENIC_SERVER_MESH_NEAREST_H_
#define PHRENIC_SERVER_MESH_NEAREST_H_

#include <limits>
#include <memory>
#include <vector>

#include "server/mesh/mesh.h"

namespace phrenic {

struct Neighbour {
  int vertex = -1;      // -1: there is none
  double distance = 0;  // [m]
};

// Immutable once built; any number of threads may ask. Keeps its own copy of the points.
class NearestSearch {
 public:
  explicit NearestSearch(Points points);  // at least one point
  ~NearestSearch();
  NearestSearch(const NearestSearch&) = delete;
  NearestSearch& operator=(const NearestSearch&) = delete;

  // Equal distances are settled by the lower index, so that results do not depend on the tree. None, at an infinite
  // distance, where the nearest is farther than `reach` [m]; the less it is, the sooner that is known.
  Neighbour Nearest(const Eigen::Vector3d& point, double reach = std::numeric_limits<double>::infinity()) const;
  // Every vertex within `radius` [m], nearest first.
  std::vector<Neighbour> Within(const Eigen::Vector3d& point, double radius) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MESH_NEAREST_H_
