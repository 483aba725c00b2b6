// The generated diaphragm as a closed double layer: the thoracic and the abdominal surface, each half the gap away from
// the middle surface along its normal, joined along the rim and around the two openings. Genus 2.
#ifndef PHRENIC_SERVER_ANATOMY_DIAPHRAGM_MESH_H_
#define PHRENIC_SERVER_ANATOMY_DIAPHRAGM_MESH_H_

#include "server/mesh/mesh.h"

namespace phrenic::anatomy {

// Returns the mesh [mm] with edges of about `edge_length` [mm], finer near the openings and in the crura. Vertex 2 i is
// on the thoracic layer and 2 i + 1 faces it on the abdominal one (UpperVertex, LowerVertex). Regions: "tendon";
// "muscle", the rest; "rim", the muscle near the costal and lumbar insertions; "crus-right" and "crus-left", disjoint
// from "rim".
Mesh DiaphragmMesh(double edge_length);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_DIAPHRAGM_MESH_H_
