// Skin weights for points between several bodies, by inverse distance.
#ifndef PHRENIC_SERVER_MECHANICS_SKINNING_INVERSE_DISTANCE_WEIGHTS_H_
#define PHRENIC_SERVER_MECHANICS_SKINNING_INVERSE_DISTANCE_WEIGHTS_H_

#include <vector>

#include "server/mechanics/skinning/skin_drivers.h"

namespace phrenic {

// Weights w_d ~ (d^2 + (5 mm)^2)^(-2), d the distance to a driver: smooth, with the nearest driver dominating. Weights
// below 1 % of the largest are dropped and the rest scaled to a sum of 1. The result for one point bounds the search
// for the next, so that neighbouring points are fast; it does not change results. The drivers must outlive it. Not
// thread-safe.
class InverseDistanceWeights {
 public:
  explicit InverseDistanceWeights(const SkinDrivers& drivers);
  // Appends the weights of a point at rest [m] as those of `for_vertex`, sorted by driver.
  void Append(const Eigen::Vector3d& point, int for_vertex, std::vector<SkinWeight>& weights);

 private:
  // The result of the last nearest-vertex search in a driver.
  struct Track {
    Eigen::Vector3d from = Eigen::Vector3d::Zero();  // the point
    double distance = 0;                             // [m]
    int vertex = 0;                                  // the nearest one of the driver
    double weight = 0;                               // for the present point

    double AtLeast(const Eigen::Vector3d& point) const;
  };
  double AtMost(int driver, const Eigen::Vector3d& point) const;
  void Find(int driver, const Eigen::Vector3d& point);
  void LookAround(const Eigen::Vector3d& point);
  void Weigh(const Eigen::Vector3d& point);

  const SkinDrivers& drivers_;
  std::vector<Track> tracks_;
  int nearest_ = 0;
  Eigen::Vector3d middle_;   // the point for which around_ was computed [m]
  std::vector<int> around_;  // candidate drivers of points near middle_
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SKINNING_INVERSE_DISTANCE_WEIGHTS_H_
