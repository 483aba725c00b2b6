// Markers on a person's chest wall: their places at rest and at the end of an inspiration.
//
// A CSV of pairs with the columns name, rest_x, rest_y, rest_z, moved_x, moved_y, moved_z; or of tracks, with a frame a
// line and the columns NAME_x, NAME_y, NAME_z of each marker. In mm and LPS, in the frame of the other data; a line
// "# space=ras" turns RAS, and "# place=centred" moves the markers' middle onto that of the lungs.
#ifndef PHRENIC_SERVER_FIT_MARKERS_H_
#define PHRENIC_SERVER_FIT_MARKERS_H_

#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "server/mesh/mesh.h"

namespace phrenic::fit {

// In metres, one column per marker.
struct Markers {
  std::vector<std::string> names;
  Points rest, motion;
  bool centred = false;  // to be moved onto the lungs
};

inline constexpr int kMostMarkers = 2000;
inline constexpr int kMostMarkerFrames = 100'000;

// Parses markers. Of tracks, rest is the mean of the tenth of the frames in which the markers are closest together, and
// the moved place that of the tenth in which they are farthest apart: the chest widens in an inspiration.
// INVALID_ARGUMENT "name:line: problem and remedy"; also for markers that do not extend as a chest does, 60 to 800 mm,
// or move by more than 150 mm. Thread-safe.
absl::StatusOr<Markers> ParseMarkers(std::string_view name, std::string_view bytes);

}  // namespace phrenic::fit

#endif  // PHRENIC_SERVER_FIT_MARKERS_H_
