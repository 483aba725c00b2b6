// Label maps: the anatomical meaning of the numbers in a label volume.
#ifndef PHRENIC_SERVER_IMAGING_LABEL_MAP_H_
#define PHRENIC_SERVER_IMAGING_LABEL_MAP_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "phrenic/v1/patient.pb.h"
#include "server/imaging/label_volume.h"

namespace phrenic::imaging {

// Reads the installed map of that name ("totalsegmentator"), or a file if the argument has a "/" or ends in .textproto.
// NOT_FOUND names the file, INVALID_ARGUMENT its line and field.
absl::StatusOr<v1::LabelMap> ReadLabelMap(const std::string& name_or_file);

// Returns the map with the volume's numbers, matched by label name; the map unchanged if the volume has no names or
// none matches, which adds a remark. A label is known by its name, else by the words of its name in any order and case
// ("Lung, upper lobe (left)" is lung_upper_lobe_left), else by the words of its code's meaning ("Second rib Left" is
// rib_left_2).
v1::LabelMap Resolve(const v1::LabelMap& map, const LabelVolume& volume, std::vector<std::string>& remarks);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_LABEL_MAP_H_
