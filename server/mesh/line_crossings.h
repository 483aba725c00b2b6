// Where the lines of a regular grid cross a surface, for volume fractions and inside tests of many points at once.
#ifndef PHRENIC_SERVER_MESH_LINE_CROSSINGS_H_
#define PHRENIC_SERVER_MESH_LINE_CROSSINGS_H_

#include <vector>

#include "server/mesh/mesh.h"

namespace phrenic {

// Returns the heights z at which each line along z crosses the surface, ascending, for lines.x() x lines.y() lines;
// line (i, j), at index j lines.x() + i, is at x = i, y = j. `vertices` (3 x n) are in units of the grid. Lines are
// moved by about 1e-5, so that none passes through a vertex of the grid. A closed surface is crossed an even number of
// times: the line is inside between crossings 0 and 1, 2 and 3, ...
std::vector<std::vector<double>> LineCrossings(const ConstPoints& vertices, const Triangles& triangles,
                                               const Eigen::Vector2i& lines);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MESH_LINE_CROSSINGS_H_
