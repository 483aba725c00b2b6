// How bodies carry points: finds, at compile time, the shares of carriers for points at rest.
#ifndef PHRENIC_SERVER_MECHANICS_CARRIERS_H_
#define PHRENIC_SERVER_MECHANICS_CARRIERS_H_

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "server/mechanics/draft.h"
#include "server/mesh/nearest.h"

namespace phrenic {

// Nearest-vertex search over each of several carriers. Keeps references into the draft: use it while it lasts.
class Carriers {
 public:
  Carriers(const Draft& draft, const std::vector<int>& bodies);

  struct Contact {
    int carrier = 0;  // place in the list of bodies
    int vertex = 0;   // of that body
    double distance = 0;
  };
  Contact Nearest(const Eigen::Vector3d& point) const;
  // What the carrier does to a point near one of its vertices; `vertex` of the shares is `for_vertex`.
  std::vector<RideShare> Shares(const Contact& contact, int for_vertex) const;
  // Shares of all carriers by inverse distance, w_c ~ (d_c^2 + (5 mm)^2)^(-2): smooth, and the nearest has the say.
  std::vector<RideShare> Blend(const Eigen::Vector3d& point, int for_vertex) const;

 private:
  std::vector<int> NearestBoxFirst(const Eigen::Vector3d& point) const;

  const Draft& draft_;
  std::vector<int> bodies_;
  std::vector<std::unique_ptr<NearestSearch>> searches_;
  std::vector<Eigen::AlignedBox3d> boxes_;  // what is outside reach is not searched
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_CARRIERS_H_
