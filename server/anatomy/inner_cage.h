// The inner face of the rib cage, smooth: the surface on which the diaphragm lies and slides in its zone of apposition.
// Every rib, cartilage and vertebral body is outside it (ribs 9 and 10 by 0.4 mm, the others by more), the middle sheet
// (middle_sheet.h) inside or on it. It is the horizontal cross-section of the cage (dimensions.h),
// kDiaphragmInset inside the ribs' centrelines, at each height.
#ifndef PHRENIC_SERVER_ANATOMY_INNER_CAGE_H_
#define PHRENIC_SERVER_ANATOMY_INNER_CAGE_H_

#include "server/anatomy/physique.h"
#include "server/mesh/mesh.h"

namespace phrenic::anatomy {

// Returns a tube [mm], open below (z = 0, the lower end plate of L3) and above (z = 396 mm, the thoracic inlet), as a
// grid of azimuth and height; triangles face outwards. Vertex (i, j) has the index
//   j * columns + i,
// row j at z = 396 j / (rows - 1), column i at the azimuth 2 pi i / columns from the front (-y) towards the left (+x):
// the point of the cross-section at the disc coordinates (sin, -cos) of the azimuth, moved outwards by the sag of its
// edges (at most 0.2 mm at 4 mm), so that no edge cuts into the cage. For edges of `edge_length` [mm]
//   rows = 1 + 396 / edge_length, columns = 4 (144 / edge_length), rounded; at least 2 and 8:
// 100 x 144 at 4 mm. Region "bottom" is row 0, so its size is the number of columns; "top" is the last row. The
// diagonals mirror each other in x = 0. Below z = 264 mm each row is seen whole from the axis x = 0, y = -60 mm; from
// one further back the flanks of the vertebral column hide the gutters beside it. Deterministic and thread-safe.
Mesh InnerCage(double edge_length);

// Returns the tube of a person: the same grid on the surface to which the map carries the adult's. Its rows are
// horizontal still, evenly from z where the map carries the origin to the highest one that every meridian reaches.
Mesh InnerCage(double edge_length, const PhysiqueMap& map);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_INNER_CAGE_H_
