// Repairs of triangle surfaces as other programs write them. Each does one thing, keeps the order of what stays,
// renumbers regions and edges, and says how much it changed. None is done unless asked for.
#ifndef PHRENIC_SERVER_MESH_REPAIR_H_
#define PHRENIC_SERVER_MESH_REPAIR_H_

#include "server/mesh/mesh.h"

namespace phrenic {

// Makes one of vertices that lie within `tolerance` [m] of each other, at the place of the first, and drops vertices
// that nothing uses. Returns how many vertices there are less.
int Weld(double tolerance, Mesh& mesh);

// Takes away triangles whose least height is under `height` [m]: a needle's short side becomes one vertex, a flat
// triangle's long side is flipped, so that no hole is left and the surface moves by less than `height`; of two
// triangles of the same three vertices one is dropped where they face the same way, both where they are back to back.
// Returns how many triangles were slivers or doubled. What cannot be flipped (at an open edge, or where the new edge is
// there already) is dropped at an open edge and left elsewhere.
int DropSlivers(double height, Mesh& mesh);

// Drops the pieces of surface that hang on an edge of three triangles or more and end in an open edge. Returns how many
// triangles they had.
int DropFins(Mesh& mesh);

// Turns triangles until neighbours agree and closed components face outwards; of a component that is open, or has no
// two sides, the larger part keeps its side. A closed component inside the bounds of a larger one may be a hollow: it
// is turned whole or not at all. Returns how many triangles were turned.
int Orient(Mesh& mesh);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MESH_REPAIR_H_
