// The points of 3D Slicer's markups: .fcsv (Markups fiducial file) and .mrk.json (markups schema 1.0).
#ifndef PHRENIC_SERVER_FIT_SLICER_POINTS_H_
#define PHRENIC_SERVER_FIT_SLICER_POINTS_H_

#include <string_view>

#include "absl/status/statusor.h"
#include "server/fit/landmarks.h"

namespace phrenic::fit {

// Return the points as exhale points with their labels. The coordinate system of an .fcsv is LPS or RAS, or 1 or 0 of
// older versions; RAS if it is not stated, as in Slicer. A .mrk.json gives the points of its first markup.
absl::StatusOr<Landmarks> ParseFcsv(std::string_view name, std::string_view bytes);
absl::StatusOr<Landmarks> ParseMarkups(std::string_view name, std::string_view bytes);

// Appends a point in mm. INVALID_ARGUMENT, without the place, if a coordinate is not finite or farther than kFarthest.
absl::Status AppendPoint(const Eigen::Vector3d& mm, bool ras, std::vector<Eigen::Vector3d>& points);
// Returns one column per point.
Points ColumnsOf(const std::vector<Eigen::Vector3d>& points);

}  // namespace phrenic::fit

#endif  // PHRENIC_SERVER_FIT_SLICER_POINTS_H_
