// A set of points in space that keep their distance, and the quasi-random sequence that proposes them.
#ifndef PHRENIC_SERVER_ANATOMY_SPACED_POINTS_H_
#define PHRENIC_SERVER_ANATOMY_SPACED_POINTS_H_

#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace phrenic::anatomy {

// Point i of the additive recurrence with the plastic number: evenly scattered over the unit square (Roberts 2018,
// "R2" sequence; Martin, Craster and Kearney for the plastic number's property).
Eigen::Vector2d QuasiRandom(int64_t i);

// One thread. Every point has its own aimed spacing; two points are too near when their distance is less than `apart`
// times the smaller of their spacings.
class SpacedPoints {
 public:
  // `largest` and `smallest` bound the spacings.
  SpacedPoints(double largest, double apart, double smallest);

  void Add(const Eigen::Vector3d& point, double spacing);
  bool TryAdd(const Eigen::Vector3d& point, double spacing);

 private:
  struct Entry {
    Eigen::Vector3d point;
    double spacing;
  };
  int64_t Key(const Eigen::Vector3i& cell) const;
  Eigen::Vector3i Cell(const Eigen::Vector3d& point) const;

  double cell_, apart_;
  std::unordered_map<int64_t, std::vector<Entry>> cells_;
};

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_SPACED_POINTS_H_
