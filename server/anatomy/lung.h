// Lungs: what the cage leaves above the diaphragm on either side of the mediastinum. They are seen, not simulated.
#ifndef PHRENIC_SERVER_ANATOMY_LUNG_H_
#define PHRENIC_SERVER_ANATOMY_LUNG_H_

#include "server/mesh/mesh.h"

namespace phrenic::anatomy {

// The smooth intersection of the inside of the cage, of what lies above the diaphragm's domes by a few millimetres and
// of what lies beside spine, mediastinum and heart [mm]. The base follows the dome; the costophrenic recess below its
// edge is free of lung; the apex rises above the first rib; the heart's impression is deeper on the left (the cardiac
// notch). Genus 0.
Mesh LeftLung(double edge_length);
Mesh RightLung(double edge_length);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_LUNG_H_
