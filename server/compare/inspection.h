// What a surface file holds, and whether it will do.
#ifndef PHRENIC_SERVER_COMPARE_INSPECTION_H_
#define PHRENIC_SERVER_COMPARE_INSPECTION_H_

#include <string>

#include "phrenic/v1/inspect.pb.h"
#include "server/meshio/meshio.h"

namespace phrenic::compare {

// Counts and measures `surface`, read in metres from a file of that name whose unit is `unit_mm` [mm].
v1::SurfaceReport Inspect(const std::string& name, const meshio::Surface& surface, double unit_mm);

// "mm", "cm" or "m" where something of this largest extent [units of its file] is as large as a part of a trunk in that
// unit and in no other of the three; else empty.
std::string LikelyUnit(double extent);

}  // namespace phrenic::compare

#endif  // PHRENIC_SERVER_COMPARE_INSPECTION_H_
