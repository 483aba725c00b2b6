// What the numbers of a label volume mean.
#ifndef PHRENIC_SERVER_IMAGING_LABEL_MAP_H_
#define PHRENIC_SERVER_IMAGING_LABEL_MAP_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "phrenic/v1/patient.pb.h"
#include "server/imaging/label_volume.h"

namespace phrenic::imaging {

// The map of that name that comes along ("totalsegmentator"), or that the text file says. NOT_FOUND names the file,
// INVALID_ARGUMENT its line and field.
absl::StatusOr<v1::LabelMap> ReadLabelMap(const std::string& name_or_file);

// The map with the numbers that the volume gives its names, where it names its labels.
v1::LabelMap Resolve(const v1::LabelMap& map, const LabelVolume& volume);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_LABEL_MAP_H_
