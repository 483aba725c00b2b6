// The generated lungs: the space in the cage above the diaphragm on either side of the mediastinum. Displayed, not
// simulated.
#ifndef PHRENIC_SERVER_ANATOMY_LUNG_H_
#define PHRENIC_SERVER_ANATOMY_LUNG_H_

#include <Eigen/Core>

#include "server/mesh/mesh.h"

namespace phrenic::anatomy {

// Return the surface [mm] of the smooth intersection of three fields: inside the cage, a few millimetres above the
// diaphragm's domes, and outside spine, mediastinum and heart. The base follows the dome; the costophrenic recess is
// empty; the apex rises above the first rib; the cardiac impression is deeper on the left. Closed, genus 0, edges of
// about `edge_length` [mm].
Mesh LeftLung(double edge_length);
Mesh RightLung(double edge_length);

// Returns the field of which a lung is the inside: an approximate signed distance [mm], negative inside. What lies
// between the lungs stays outside of both.
double LungField(const Eigen::Vector3d& x, bool left);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_LUNG_H_
