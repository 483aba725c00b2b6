// How bodies carry points that lie between several of them: shares of each by its distance.
#ifndef PHRENIC_SERVER_MECHANICS_SKINNING_INVERSE_DISTANCE_WEIGHTS_H_
#define PHRENIC_SERVER_MECHANICS_SKINNING_INVERSE_DISTANCE_WEIGHTS_H_

#include <vector>

#include "server/mechanics/skinning/skin_drivers.h"

namespace phrenic {

// Shares of carriers by inverse distance, w_c ~ (d_c^2 + (5 mm)^2)^(-2): smooth, and the nearest has the say; those
// below 1 % of the nearest's are dropped and the rest scaled to 1. What is found for one point bounds the search for
// the next, so that points close together are soon done; it changes no result. Not thread-safe; use it while the
// carriers last.
class InverseDistanceWeights {
 public:
  explicit InverseDistanceWeights(const SkinDrivers& carriers);
  // Appends the shares of a point, by carrier; `vertex` of them is `for_vertex`.
  void Blend(const Eigen::Vector3d& point, int for_vertex, std::vector<SkinWeight>& shares);

 private:
  // What is known of a carrier: how far it was from the point it was last sought from.
  struct Track {
    Eigen::Vector3d from = Eigen::Vector3d::Zero();
    double distance = 0;  // [m]
    int vertex = 0;       // nearest then
    double weight = 0;    // for the present point

    double AtLeast(const Eigen::Vector3d& point) const;
  };
  double AtMost(int carrier, const Eigen::Vector3d& point) const;
  void Find(int carrier, const Eigen::Vector3d& point);
  void LookAround(const Eigen::Vector3d& point);
  void Weigh(const Eigen::Vector3d& point);

  const SkinDrivers& carriers_;
  std::vector<Track> tracks_;
  int nearest_ = 0;
  Eigen::Vector3d middle_;   // points around it ...
  std::vector<int> around_;  // ... are carried by no others than these
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SKINNING_INVERSE_DISTANCE_WEIGHTS_H_
