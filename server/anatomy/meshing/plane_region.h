// A region of the plane bounded by closed polygons, with a fast point-in-polygon test.
#ifndef PHRENIC_SERVER_ANATOMY_MESHING_PLANE_REGION_H_
#define PHRENIC_SERVER_ANATOMY_MESHING_PLANE_REGION_H_

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace phrenic::anatomy {

// Even-odd rule, so loops inside the first are holes. Immutable, thread-safe.
class PlaneRegion {
 public:
  // Requires: at least one loop of three points or more.
  explicit PlaneRegion(const std::vector<std::vector<Eigen::Vector2d>>& loops);

  bool Contains(const Eigen::Vector2d& point) const;
  // Corners of the bounding box.
  const Eigen::Vector2d& low() const { return low_; }
  const Eigen::Vector2d& high() const { return high_; }

 private:
  using Segment = std::pair<Eigen::Vector2d, Eigen::Vector2d>;
  int Row(double y) const;

  Eigen::Vector2d low_, high_;
  std::vector<std::vector<Segment>> rows_;  // the segments that intersect each horizontal band
};

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_MESHING_PLANE_REGION_H_
