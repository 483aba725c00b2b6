// Costal cartilages: 1 to 7 join the ribs to the sternum, 8 to 10 each the one above; together the costal margin.
#ifndef PHRENIC_SERVER_ANATOMY_CARTILAGE_H_
#define PHRENIC_SERVER_ANATOMY_CARTILAGE_H_

#include "server/anatomy/tube.h"

namespace phrenic::anatomy {

// Control points of the left cartilage's centreline (number 1 to 10), from the rib's anterior end, along the cage, to
// the sternum's edge or to the cartilage above [mm].
Curve LeftCartilagePath(int number);

// The left cartilage [mm]; the right one is its mirror image.
Mesh LeftCartilage(int number, double edge_length);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_CARTILAGE_H_
