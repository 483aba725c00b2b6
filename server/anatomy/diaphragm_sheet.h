// The triangulated middle surface of the generated diaphragm, with its rim and its two openings as boundary loops. Both
// meshes of the diaphragm are made of it: the closed double layer (diaphragm_mesh.h) and the single one for mechanics
// (middle_sheet.h).
#ifndef PHRENIC_SERVER_ANATOMY_DIAPHRAGM_SHEET_H_
#define PHRENIC_SERVER_ANATOMY_DIAPHRAGM_SHEET_H_

#include "server/anatomy/sheet_mesh.h"

namespace phrenic::anatomy {

// The boundary loops of DiaphragmSheet, in order.
inline constexpr size_t kRimLoop = 0, kCavalLoop = 1, kOesophagealLoop = 2;

// Returns the sheet [mm] with edges of about `edge_length` [mm], finer near the openings and in the crura. Triangles
// face the thorax. Deterministic and thread-safe.
Sheet DiaphragmSheet(double edge_length);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_DIAPHRAGM_SHEET_H_
