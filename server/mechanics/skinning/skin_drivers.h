// How bodies carry points: finds, at compile time, the shares of carriers for points at rest.
#ifndef PHRENIC_SERVER_MECHANICS_SKINNING_SKIN_DRIVERS_H_
#define PHRENIC_SERVER_MECHANICS_SKINNING_SKIN_DRIVERS_H_

#include <Eigen/Geometry>
#include <limits>
#include <vector>

#include "server/mechanics/model_builder.h"
#include "server/mesh/nearest.h"

namespace phrenic {

// Nearest-vertex search over each of several carriers. Keeps references into the builder: use it while it lasts.
class SkinDrivers {
 public:
  static constexpr double kAnywhere = std::numeric_limits<double>::infinity();

  SkinDrivers(const ModelBuilder& builder, const std::vector<int>& bodies);

  struct Contact {
    int carrier = 0;  // place in the list of bodies
    int vertex = 0;   // of that body
    double distance = 0;
  };
  // At an infinite distance where none is nearer than `reach` [m]; the less it is, the sooner that is known.
  Contact Nearest(const Eigen::Vector3d& point, double reach = kAnywhere) const;
  // Appends what the carrier does to a point near one of its vertices, by `weight`; `vertex` of the shares is
  // `for_vertex`.
  void AppendWeights(const Contact& contact, int for_vertex, double weight, std::vector<SkinWeight>& shares) const;

  int count() const { return static_cast<int>(bodies_.size()); }
  const NearestSearch& search(int carrier) const { return *searches_[carrier]; }
  const Points& vertices(int carrier) const { return builder_.model.bodies[bodies_[carrier]].mesh.vertices; }

 private:
  const ModelBuilder& builder_;
  std::vector<int> bodies_;
  std::vector<const NearestSearch*> searches_;
  std::vector<Eigen::AlignedBox3d> boxes_;  // what is outside reach is not searched
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SKINNING_SKIN_DRIVERS_H_
