// The bodies that drive a skin: finds, at compile time, which of them is near a point at rest.
#ifndef PHRENIC_SERVER_MECHANICS_SKINNING_SKIN_DRIVERS_H_
#define PHRENIC_SERVER_MECHANICS_SKINNING_SKIN_DRIVERS_H_

#include <Eigen/Geometry>
#include <limits>
#include <vector>

#include "server/mechanics/model_builder.h"
#include "server/mesh/nearest.h"

namespace phrenic {

// A nearest-vertex search over several bodies. The builder must outlive it. Immutable, but not thread-safe, because the
// builder is not.
class SkinDrivers {
 public:
  static constexpr double kAnywhere = std::numeric_limits<double>::infinity();

  SkinDrivers(const ModelBuilder& builder, const std::vector<int>& bodies);

  struct Nearby {
    int driver = 0;  // index in the list of bodies
    int vertex = 0;  // of that body
    double distance = 0;
  };
  // Returns the nearest vertex of all bodies, with infinite distance if none is within `reach` [m]. A smaller reach
  // makes the search faster.
  Nearby Nearest(const Eigen::Vector3d& point, double reach = kAnywhere) const;
  // Appends the weights by which `for_vertex` follows the driver of `nearby`. Their sum is `weight`, or less if a
  // skinned driver follows bodies that do not move.
  void AppendWeights(const Nearby& nearby, int for_vertex, double weight, std::vector<SkinWeight>& weights) const;

  int count() const { return static_cast<int>(bodies_.size()); }
  const NearestSearch& search(int driver) const { return *searches_[driver]; }
  const Points& vertices(int driver) const { return builder_.model.bodies[bodies_[driver]].mesh.vertices; }

 private:
  const ModelBuilder& builder_;
  std::vector<int> bodies_;
  std::vector<const NearestSearch*> searches_;
  std::vector<Eigen::AlignedBox3d> boxes_;  // of the bodies, to skip those out of reach
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SKINNING_SKIN_DRIVERS_H_
