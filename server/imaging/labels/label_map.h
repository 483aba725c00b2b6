// Label maps: the anatomical meaning of the numbers and names in a label volume.
#ifndef PHRENIC_SERVER_IMAGING_LABELS_LABEL_MAP_H_
#define PHRENIC_SERVER_IMAGING_LABELS_LABEL_MAP_H_

#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "phrenic/v1/patient.pb.h"
#include "server/imaging/label_volume.h"

namespace phrenic::imaging {

// The installed map whose names are those of labels in all others.
inline constexpr char kNamesMap[] = "totalsegmentator";

// Reads the installed map of that name ("totalsegmentator"), or a file if the argument has a "/" or ends in .textproto.
// NOT_FOUND names the file and the installed maps, INVALID_ARGUMENT its line and field.
absl::StatusOr<v1::LabelMap> ReadLabelMap(const std::string& name_or_file);

// Returns the names of the installed maps: "totalsegmentator" and "vista3d", then the others by name.
std::vector<std::string> InstalledLabelMaps();

// Returns the map with meanings that segmentations of other programs have: "lung_left", "lung_right", "ribs" (all of
// them in one label) and "diaphragm", of number 0. Pure function, thread-safe.
v1::LabelMap WithCommonNames(const v1::LabelMap& map);

// Returns a meaning for each label of the volume whose name the map knows, with the label's number; the map unchanged
// if the volume has no names or none is known, which adds a remark. A label is known by its name, else by the words of
// its name in any order and case ("Lung, upper lobe (left)" is lung_upper_lobe_left), else by the words of its code's
// meaning ("Second rib Left" is rib_left_2). Labels of one part (label_set.h) may have one meaning.
v1::LabelMap Resolve(const v1::LabelMap& map, const LabelVolume& volume, std::vector<std::string>& remarks);

// Returns the words of a file's name that are the name of a label of the map: "rib_left_7" of
// "case-12_CT_Rib-left-07.nii.gz"; empty if it has none, or two.
std::string LabelOfFile(const v1::LabelMap& map, std::string_view file_name);

// Returns the map with the names that `names` has for its labels: those of chambers of the heart become "heart".
v1::LabelMap WithNamesOf(const v1::LabelMap& names, const v1::LabelMap& map);

// Gives labels of one name one number, which is the only one of that name in the returned map. Thread-safe.
v1::LabelMap UniteLabels(const v1::LabelMap& map, LabelVolume& volume);

// True if two labels have one name.
bool HasRepeatedNames(const v1::LabelMap& map);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_LABELS_LABEL_MAP_H_
