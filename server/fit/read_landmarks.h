// Files of landmarks.
//
// A file is CSV, 3D Slicer's .fcsv or .mrk.json. Coordinates are in mm and LPS (+x left, +y posterior, +z superior),
// unless the file declares RAS: "# space=ras" in a CSV, CoordinateSystem in an .fcsv, coordinateSystem in a .mrk.json.
// A CSV has a header that names its columns, in any order: exhale_x, exhale_y, exhale_z and, for pairs, inhale_x,
// inhale_y, inhale_z; points alone may be called x, y, z. A column phase gives pairs of several times
// (Landmarks::phase). Other columns are ignored, and so are lines that begin with #.
#ifndef PHRENIC_SERVER_FIT_READ_LANDMARKS_H_
#define PHRENIC_SERVER_FIT_READ_LANDMARKS_H_

#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "server/fit/landmarks.h"

namespace phrenic::fit {

// Parses a file in the format of `name`'s extension; any other extension is read as CSV. INVALID_ARGUMENT
// "name:line: problem and remedy". Thread-safe, like all functions here.
absl::StatusOr<Landmarks> ParseLandmarks(std::string_view name, std::string_view bytes);

// Reads one file of points or pairs, or two files to pair. Also NOT_FOUND with the path.
absl::StatusOr<Landmarks> ReadLandmarks(const std::vector<std::string>& files);

}  // namespace phrenic::fit

#endif  // PHRENIC_SERVER_FIT_READ_LANDMARKS_H_
