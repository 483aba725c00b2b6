// The diaphragm as a closed double layer: the thoracic and the abdominal surface, half the gap to either side of the
// middle surface along its normal, joined along the border and round the two openings; so a sphere with two handles.
#ifndef PHRENIC_SERVER_ANATOMY_DIAPHRAGM_MESH_H_
#define PHRENIC_SERVER_ANATOMY_DIAPHRAGM_MESH_H_

#include "server/mesh/mesh.h"

namespace phrenic::anatomy {

// In millimetres. `edge_length` [mm] is kept except near the openings and in the crura, which take finer ones where
// they need them. With n vertices in all, vertex i < n / 2 is thoracic and i + n / 2 faces it on the abdominal surface.
// Regions: "tendon"; "muscle", all the rest; "rim", the muscle near the costal and lumbar border; "crus-right" and
// "crus-left", the pillars (not in "rim").
Mesh DiaphragmMesh(double edge_length);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_DIAPHRAGM_MESH_H_
