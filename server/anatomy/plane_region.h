// A region of the plane bounded by closed polygons.
#ifndef PHRENIC_SERVER_ANATOMY_PLANE_REGION_H_
#define PHRENIC_SERVER_ANATOMY_PLANE_REGION_H_

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace phrenic::anatomy {

// Immutable; any thread. The even-odd rule decides, so that loops inside the first are holes.
class PlaneRegion {
 public:
  explicit PlaneRegion(const std::vector<std::vector<Eigen::Vector2d>>& loops);

  bool Contains(const Eigen::Vector2d& point) const;
  const Eigen::Vector2d& low() const { return low_; }
  const Eigen::Vector2d& high() const { return high_; }

 private:
  using Side = std::pair<Eigen::Vector2d, Eigen::Vector2d>;
  int Row(double y) const;

  Eigen::Vector2d low_, high_;
  std::vector<std::vector<Side>> rows_;  // the sides that reach into each horizontal band
};

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_PLANE_REGION_H_
