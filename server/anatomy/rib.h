// Ribs: flattened tubes along a curve from the vertebra over neck, tubercle and angle round the cage.
#ifndef PHRENIC_SERVER_ANATOMY_RIB_H_
#define PHRENIC_SERVER_ANATOMY_RIB_H_

#include "server/anatomy/tube.h"

namespace phrenic::anatomy {

// Control points of the left rib's centreline (number 1 to 12) from head to anterior end [mm]. Beyond the angle the rib
// lies where the plane z = z_t + tan(sagittal slope) (y - y_t) - tan(frontal slope) (|x| - x_t) through its tubercle
// cuts the cage; the slopes and the end's azimuth are smooth laws of the rib's number (sagittal 31 to 22 degrees,
// frontal 7 to 50 degrees from the first to the last).
Curve LeftRibPath(int number);

// The left rib [mm]; the right one is its mirror image. The head is the end nearest to the midplane.
Mesh LeftRib(int number, double edge_length);

// Horizontal direction out of the cage at a point on its wall (left or right).
Eigen::Vector3d OutOfCage(const Eigen::Vector3d& point);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_RIB_H_
