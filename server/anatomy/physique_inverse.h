// The inverse of a person's map of space.
#ifndef PHRENIC_SERVER_ANATOMY_PHYSIQUE_INVERSE_H_
#define PHRENIC_SERVER_ANATOMY_PHYSIQUE_INVERSE_H_

#include <Eigen/Core>

#include "server/anatomy/physique.h"

namespace phrenic::anatomy {

// Finds the points that a map carries to given ones by Newton's method, with the derivative of an earlier step while
// that converges: fast for points near the one before, such as those of a row of voxels. Not thread-safe.
class PhysiqueInverse {
 public:
  // `map` must outlive it.
  explicit PhysiqueInverse(const PhysiqueMap& map);

  // Returns the adult's point [mm] that the map carries to within 0.01 mm of `person` [mm]; far outside the cage, where
  // no step comes as close, the nearest that 40 steps find.
  Eigen::Vector3d operator()(const Eigen::Vector3d& person);

 private:
  void Differentiate();

  const PhysiqueMap& map_;
  Eigen::Vector3d adult_, image_;  // the last point, and to where the map carries it
  Eigen::Matrix3d step_;           // of the adult's point for one of the image
};

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_PHYSIQUE_INVERSE_H_
