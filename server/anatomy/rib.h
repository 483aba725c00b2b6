// Ribs: flattened tubes along a curve from the vertebra over neck, tubercle and angle around the cage.
//
// Sources: rounded adult dimensions of general anatomy: shaft 12 mm high and 6 mm thick, first rib 17 mm broad and
// flat, head and neck 25 mm long.
#ifndef PHRENIC_SERVER_ANATOMY_RIB_H_
#define PHRENIC_SERVER_ANATOMY_RIB_H_

#include "server/anatomy/meshing/tube.h"

namespace phrenic::anatomy {

// Returns the control points of the left rib's centreline (number 1 to 12) from head to anterior end [mm]. Beyond the
// angle the rib is the intersection of the cage with the plane through its tubercle t,
//   z = z_t + tan(sagittal slope) (y - y_t) - tan(frontal slope) (|x| - x_t).
// Slopes and the azimuth of the end are smooth functions of the number: sagittal 31 to 22 degrees, frontal 7 to 50
// degrees from the first rib to the last.
Curve LeftRibPath(int number);

// Returns the left rib [mm] with edges of about `edge_length` [mm]; the right one is its mirror image. The head is the
// end nearest to the midsagittal plane. Ribs 1 to 10 end straight, at the cartilage.
Mesh LeftRib(int number, double edge_length);

// The anterior end of a rib, where its cartilage continues it.
struct RibEnd {
  Eigen::Vector3d centre, along;  // along: the unit direction of the rib
  TubeSection section;
};
RibEnd LeftRibEnd(int number);

// Returns the unit normal of the cage, outwards, at a point on its wall on either side.
Eigen::Vector3d OutOfCage(const Eigen::Vector3d& point);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_RIB_H_
