// The generated heart in its pericardium: displayed, not simulated. It rests on the central tendon and fills the space
// between the lungs behind the sternum; the pulmonary trunk rises from it and divides.
#ifndef PHRENIC_SERVER_ANATOMY_HEART_H_
#define PHRENIC_SERVER_ANATOMY_HEART_H_

#include "server/mesh/mesh.h"

namespace phrenic::anatomy {

// Returns the surface [mm]: four rounded chambers, cut by the lungs, the chest wall and the diaphragm, which is at
// least 3.5 mm away from the middle surface of the sheet. Closed, genus 0, edges of at most 9 mm.
Mesh Heart(double edge_length);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_HEART_H_
