// The tubes that pass the diaphragm: aorta, venae cavae and oesophagus. Displayed, not simulated.
//
// The inferior vena cava and the oesophagus pass through the middle of their openings. The aorta passes behind the
// sheet, in front of T12, and between the crura: the generated sheet is 2 to 4 mm in front of discs and vertebrae
// there, so that the aorta, 18 mm wide above, is 13 to 15 mm wide and 0.7 to 2 mm thick from z = 165 to 120 mm and 7 mm
// wide in the hiatus. At rest it touches the heart alone, and lies partly in the generated lungs, as the heart and the
// superior vena cava do. In quiet and deep breaths it touches neither sheet nor spine; in a sniff the sheet is pressed
// 0.6 mm into it, in full expiration, up to 7 mm.
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
