// Reads label volumes of every supported file format.
#ifndef PHRENIC_SERVER_IMAGING_LABEL_FILE_H_
#define PHRENIC_SERVER_IMAGING_LABEL_FILE_H_

#include <cstddef>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "server/imaging/label_volume.h"

namespace phrenic::imaging {

// Parses a DICOM Segmentation (dicom_segmentation.h) or a NIfTI file (nifti.h). The content decides, not the name's
// ending. INVALID_ARGUMENT "name: ..." with problem and remedy; RESOURCE_EXHAUSTED for more than `max_voxels`, before
// their memory is allocated. Thread-safe.
absl::StatusOr<LabelVolume> ParseLabels(std::string_view name, std::string_view bytes,
                                        std::size_t max_voxels = kMaxVoxels);

// INVALID_ARGUMENT "name: ..." if the first bytes are those of neither DICOM nor NIfTI. Reads no more. Thread-safe.
absl::Status CheckLabelFormat(std::string_view name, std::string_view bytes);

// True if the first bytes are those of NIfTI, or of a DICOM Segmentation or RT Structure Set. Thread-safe.
bool IsLabelFile(std::string_view bytes);

// Reads and parses a file. NOT_FOUND names the path, and says so if it is a folder.
absl::StatusOr<LabelVolume> ReadLabels(const std::string& path);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_LABEL_FILE_H_
