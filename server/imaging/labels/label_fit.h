// Finds the label map of the program that numbered a label volume.
#ifndef PHRENIC_SERVER_IMAGING_LABELS_LABEL_FIT_H_
#define PHRENIC_SERVER_IMAGING_LABELS_LABEL_FIT_H_

#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "phrenic/v1/patient.pb.h"
#include "server/imaging/label_volume.h"

namespace phrenic::imaging {

// How well a map's numbers agree with a volume. A label agrees if its volume [ml] is within the range of its structure
// in people, it lies above the next rib or vertebra, and a left one lies left of the right one of its number.
struct MapFit {
  std::string name;  // "vista3d"
  v1::LabelMap map;
  int agree = 0;  // labels of the map in the volume
  int differ = 0;
  bool named = false;  // the file's name has one of the map's words
  int Score() const { return agree - differ; }
};

// Returns the maps, the best first: those that the file's name names, if more of their labels agree than not; then by
// score; then in the given order. Pure function, thread-safe.
std::vector<MapFit> RankMaps(const LabelVolume& volume, std::string_view file_name, std::vector<MapFit> maps);

// Reads the installed maps that `choice` selects: empty for all, "moose-ribs" for one, "moose" for all of a program, or
// a file. The errors of ReadLabelMap.
absl::StatusOr<std::vector<MapFit>> ReadMaps(const std::string& choice);

// Returns the map for a volume that has no names, and adds a remark with its name and how well it fits. If no map fits,
// the first one. If one was chosen and another fits better, the remark says so. The errors of ReadMaps.
absl::StatusOr<MapFit> ChooseMap(const LabelVolume& volume, std::string_view file_name, const std::string& choice,
                                 std::vector<std::string>& remarks);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_LABELS_LABEL_FIT_H_
