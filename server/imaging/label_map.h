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
// none matches.
v1::LabelMap Resolve(const v1::LabelMap& map, const LabelVolume& volume);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_LABEL_MAP_H_
