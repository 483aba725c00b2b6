// The axis about which a rib turns, from its own neck.
#ifndef PHRENIC_SERVER_IMAGING_RIB_AXIS_H_
#define PHRENIC_SERVER_IMAGING_RIB_AXIS_H_

#include <Eigen/Core>

#include "server/mesh/mesh.h"

namespace phrenic::imaging {

struct RibNeck {
  Eigen::Vector3d head, tubercle;  // middles of the neck's two ends [m]
  Eigen::Vector3d Axis() const { return (tubercle - head).normalized(); }
};

// The head is the end of the rib nearest to the midsagittal plane x = 0; the neck runs from there to the tubercle, 14
// to 22 mm along (in a cage of 262 mm; times `scale` in another). Each end is the mean of the surface there.
RibNeck FindRibNeck(const Mesh& rib, double scale);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_RIB_AXIS_H_
