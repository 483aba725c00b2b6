// Estimates the axis of rotation of a rib from its neck.
#ifndef PHRENIC_SERVER_IMAGING_RIB_AXIS_H_
#define PHRENIC_SERVER_IMAGING_RIB_AXIS_H_

#include <Eigen/Core>

#include "server/mesh/mesh.h"

namespace phrenic::imaging {

struct RibNeck {
  Eigen::Vector3d head, tubercle;  // centres of the neck's ends [m]
  Eigen::Vector3d Axis() const { return (tubercle - head).normalized(); }
};

// Finds the neck. The head is the end of the rib nearest to the midsagittal plane x = 0; the tubercle is 14 to 22 mm
// away from it (times `scale`, the cage's width relative to 262 mm). Each end is the mean of the surface vertices
// there.
RibNeck FindRibNeck(const Mesh& rib, double scale);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_RIB_AXIS_H_
