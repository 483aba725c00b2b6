// The tubes that pass the diaphragm: aorta, venae cavae and oesophagus. Displayed, not simulated.
//
// The inferior vena cava and the oesophagus pass through the middle of their openings. The aorta runs in front of the
// vertebral bodies and between the crura; the generated sheet is 4 mm in front of the bodies there, so that above the
// median arcuate ligament, up to about z = 185 mm, the aorta lies in the sheet instead of behind it.
#ifndef PHRENIC_SERVER_ANATOMY_VESSELS_H_
#define PHRENIC_SERVER_ANATOMY_VESSELS_H_

#include "server/anatomy/meshing/tube.h"

namespace phrenic::anatomy {

// Return closed tubes of genus 0 [mm] with edges of about `edge_length` [mm].
Mesh Aorta(double edge_length);
Mesh SuperiorVenaCava(double edge_length);
Mesh InferiorVenaCava(double edge_length);
Mesh Oesophagus(double edge_length);

// Returns where the oesophagus ends, at the cardia of the stomach [mm].
Eigen::Vector3d OesophagusEnd();

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_VESSELS_H_
