// How bodies carry points that lie between several of them: shares of each by its distance.
#ifndef PHRENIC_SERVER_MECHANICS_BLENDER_H_
#define PHRENIC_SERVER_MECHANICS_BLENDER_H_

#include <vector>

#include "server/mechanics/carriers.h"

namespace phrenic {

// Shares of carriers by inverse distance, w_c ~ (d_c^2 + (5 mm)^2)^(-2): smooth, and the nearest has the say; those
// below 1 % are dropped and the rest scaled to 1. What is found for one point bounds the search for the next, so that
// points close together are soon done; it changes no result. Not thread-safe; use it while the carriers last.
class Blender {
 public:
  explicit Blender(const Carriers& carriers);
  // Appends the shares of a point; `vertex` of them is `for_vertex`.
  void Blend(const Eigen::Vector3d& point, int for_vertex, std::vector<RideShare>& shares);

 private:
  // What is known of a carrier: how far it was from the point it was last sought from.
  struct Track {
    Eigen::Vector3d from = Eigen::Vector3d::Zero();
    double distance = 0;  // [m]
    int vertex = 0;       // nearest then
    double at_least = 0;  // distance of the present point [m]
    bool found = false;   // from the present point: at_least is the distance
  };
  struct Weighed {
    double squared;  // of its box [m^2]
    int carrier;
    double weight;
  };
  void Find(int carrier, const Eigen::Vector3d& point);
  void FindNear(const Eigen::Vector3d& point);
  bool WeighNear(const Eigen::Vector3d& point);
  void WeighAll(const Eigen::Vector3d& point);
  void Prune(double sum);

  const Carriers& carriers_;
  std::vector<Track> tracks_;
  int nearest_ = 0;
  std::vector<Weighed> near_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_BLENDER_H_
