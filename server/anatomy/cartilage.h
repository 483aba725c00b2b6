// Costal cartilages. Numbers 1 to 7 join the ribs to the notches of the sternum, 8 to 10 merge into the cartilage
// above; their lower edges form the costal margin.
#ifndef PHRENIC_SERVER_ANATOMY_CARTILAGE_H_
#define PHRENIC_SERVER_ANATOMY_CARTILAGE_H_

#include "server/anatomy/meshing/tube.h"

namespace phrenic::anatomy {

// Returns the control points of the left cartilage's centreline (number 1 to 10) [mm]: from the rib's anterior end, in
// its direction, along the cage to the sternum, or to the lower edge of the cartilage above and along that.
Curve LeftCartilagePath(int number);

// Returns the left cartilage [mm] with edges of about `edge_length` [mm]; the right one is its mirror image. Its first
// ring is the last one of the rib.
Mesh LeftCartilage(int number, double edge_length);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_CARTILAGE_H_
