// The generated trachea with both main bronchi, which end inside the lungs. Displayed, not simulated.
#ifndef PHRENIC_SERVER_ANATOMY_AIRWAYS_H_
#define PHRENIC_SERVER_ANATOMY_AIRWAYS_H_

#include "server/mesh/mesh.h"

namespace phrenic::anatomy {

// Returns the surface [mm] with edges of at most 6 mm. Closed, genus 0. The bifurcation is at T4/T5; the right bronchus
// is wider and steeper.
Mesh Trachea(double edge_length);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_AIRWAYS_H_
