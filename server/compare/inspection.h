// Reports topology, size and defects of a surface file, and which uses the defects rule out.
#ifndef PHRENIC_SERVER_COMPARE_INSPECTION_H_
#define PHRENIC_SERVER_COMPARE_INSPECTION_H_

#include <string>

#include "phrenic/v1/inspect.pb.h"
#include "server/meshio/meshio.h"

namespace phrenic::compare {

// Inspects `surface` [m], which was read from the file `name` with the unit `unit_mm` [mm]. The report has counts of
// vertices, triangles and defects, the Euler characteristic and genus of each component (largest first), bounds [mm],
// area [mm^2], volume [ml] if every component is closed and consistently oriented, suggested repairs, and what a
// scene would refuse (refusals.h).
v1::SurfaceReport Inspect(const std::string& name, const meshio::Surface& surface, double unit_mm);

// Returns the unit "mm", "cm" or "m" in which an object of this largest extent [file units] has the size of a body part
// of the trunk (3 cm to 1 m). Returns an empty string if no unit or more than one fits.
std::string LikelyUnit(double extent);

}  // namespace phrenic::compare

#endif  // PHRENIC_SERVER_COMPARE_INSPECTION_H_
