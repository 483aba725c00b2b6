// The generated diaphragm as one layer, for mechanics: the middle surface, with its openings closed, as the vena cava,
// the oesophagus and the aorta fill them. A crus whose border is free there folds over itself: nothing holds it against
// the tension across its fibres. A membrane has half the vertices of the double layer, which follows it by
// SKIN_MODE_SHEET, and one boundary loop: the rim.
#ifndef PHRENIC_SERVER_ANATOMY_MIDDLE_SHEET_H_
#define PHRENIC_SERVER_ANATOMY_MIDDLE_SHEET_H_

#include "server/mesh/mesh.h"

namespace phrenic::anatomy {

// Returns the mesh [mm] with edges of about `edge_length` [mm], finer near the openings and in the crura. Triangles
// face the thorax and are sorted by their lowest vertex; vertices are numbered for locality. Each opening is closed by
// a fan of triangles around one vertex, its hub; the hiatus between the crura, where the sheet bridges the aorta (|x| <
// 15 mm, 75 < z < 127 mm), by a strip from one to the other. Topologically a disc. Regions:
//   "tendon"               with the loop and the hub of the caval opening
//   "muscle"               all other vertices
//   "rim"                  the boundary loop
//   "insertion"            what is fixed to bone: the rim, and all of the crura below z = 75 mm
//   "crus-right", "crus-left"                  below the arcuate ligaments, with their part of the rim
//   "caval-opening", "oesophageal-opening"     loop and hub; only the fan's triangles have all vertices in it
//   "aortic-hiatus"        the border of the hiatus, from one crus over its top to the other; only the strip's
//   triangles
//                          have all vertices in it
//   "hubs"                 both hubs
// Deterministic and thread-safe.
Mesh MiddleSheet(double edge_length);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_MIDDLE_SHEET_H_
