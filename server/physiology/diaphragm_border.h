// The border of a diaphragm: its height as a function of the azimuth about the middle of the sheet, at rest.
#ifndef PHRENIC_SERVER_PHYSIOLOGY_DIAPHRAGM_BORDER_H_
#define PHRENIC_SERVER_PHYSIOLOGY_DIAPHRAGM_BORDER_H_

#include <Eigen/Core>
#include <map>

#include "server/mesh/mesh.h"

namespace phrenic::physiology {

// Immutable, thread-safe.
class DiaphragmBorder {
 public:
  explicit DiaphragmBorder(const Mesh& sheet);

  bool exists() const { return heights_.size() > 2; }
  Eigen::Vector3d Middle() const { return {middle_.x(), middle_.y(), 0}; }
  double Azimuth(const Eigen::Vector3d& at) const;
  // True if the border is below a point of the wall. Requires: it exists.
  bool IsBelow(const Eigen::Vector3d& at) const;

 private:
  Eigen::Vector2d middle_;
  std::map<double, double> heights_;
};

}  // namespace phrenic::physiology

#endif  // PHRENIC_SERVER_PHYSIOLOGY_DIAPHRAGM_BORDER_H_
