// Label files packed as one: a zip or tar archive.
#ifndef PHRENIC_SERVER_IMAGING_LABELS_LABEL_ARCHIVE_H_
#define PHRENIC_SERVER_IMAGING_LABELS_LABEL_ARCHIVE_H_

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "server/imaging/label_volume.h"

namespace phrenic::imaging {

// Reads every label file of an archive (label_file.h) as one volume (label_set.h); `choice` selects maps, as ReadMaps.
// Files of other formats, and NIfTI files whose header is not supported, are left out, and a remark says why; archives
// in the archive are not read. INVALID_ARGUMENT "name: ..." for a damaged archive, or one without label files, with why
// files were left out; RESOURCE_EXHAUSTED for a file of more voxels, before they are unpacked, or of more than 4
// bytes for each of `max_voxels`, for 4 GiB of files, or for 5,000 entries; CANCELLED when `stopped`, asked before each
// file, is true; the errors of ParseLabels and LabelSet. Thread-safe.
absl::StatusOr<LabelVolume> ParseLabelArchive(const std::string& name, std::string_view bytes,
                                              const std::string& choice, std::size_t max_voxels = kMaxVoxels,
                                              const std::function<bool()>& stopped = nullptr);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_LABELS_LABEL_ARCHIVE_H_
