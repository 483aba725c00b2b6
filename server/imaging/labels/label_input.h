// A patient's labels from one file, an archive, or many files, with what they mean.
#ifndef PHRENIC_SERVER_IMAGING_LABELS_LABEL_INPUT_H_
#define PHRENIC_SERVER_IMAGING_LABELS_LABEL_INPUT_H_

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "phrenic/v1/patient.pb.h"
#include "server/imaging/label_volume.h"
#include "server/imaging/labels/label_fit.h"

namespace phrenic::imaging {

struct LabelInput {
  LabelVolume volume;
  v1::LabelMap meanings;      // of the volume's numbers; labels that are not known are not in it
  std::vector<MapFit> tools;  // of a volume without names: all installed maps, the best first
  std::string tool;           // the map that was used; empty if names count
  std::string remark;         // which map was used and how well it fits; empty if names count
};

// Parses a label file (label_file.h) or an archive of several (label_archive.h). Names in the files count before
// numbers; `choice` selects the map of numbers, as ReadMaps: empty, the map that fits best. Reading an archive ends
// when `stopped` is true. The errors of ParseLabels, ParseLabelArchive and ReadMaps. Thread-safe.
absl::StatusOr<LabelInput> ParseLabelInput(std::string_view name, std::string_view bytes, const std::string& choice,
                                           std::size_t max_voxels = kMaxVoxels,
                                           const std::function<bool()>& stopped = nullptr);

// The maps of files; each as `choice` of ReadMaps.
struct MapChoices {
  std::string all;
  std::map<std::string, std::string> by_file;  // by path, or name without folders; they count before `all`
};

// Reads one file, or all label files of several paths; folders are read with their subfolders. NOT_FOUND
// names a path that cannot be read, or a folder without label files; INVALID_ARGUMENT a file of `choices` that is not
// among them; RESOURCE_EXHAUSTED for a folder of more than 5,000 files; the errors of ParseLabelInput and LabelSet.
absl::StatusOr<LabelInput> ReadLabelInput(const std::vector<std::string>& paths, const MapChoices& choices);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_LABELS_LABEL_INPUT_H_
