// Reads label volumes of every supported file format.
#ifndef PHRENIC_SERVER_IMAGING_LABEL_FILE_H_
#define PHRENIC_SERVER_IMAGING_LABEL_FILE_H_

#include <cstddef>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "server/imaging/label_volume.h"

namespace phrenic::imaging {

// True if the first bytes are those of a zip or tar archive (labels/label_archive.h).
bool IsArchive(std::string_view bytes);

// Parses a DICOM Segmentation (dicom_segmentation.h) or a NIfTI file (nifti.h). The content decides, not the name's
// ending. INVALID_ARGUMENT "name: ..." with problem and remedy, also for an archive that is not read;
// RESOURCE_EXHAUSTED for more than `max_voxels`, before their memory is allocated. Thread-safe.
absl::StatusOr<LabelVolume> ParseLabels(std::string_view name, std::string_view bytes,
                                        std::size_t max_voxels = kMaxVoxels);

// INVALID_ARGUMENT "name: ..." if the first bytes are those of neither DICOM nor NIfTI; names an archive that is not
// read. Reads no more. Thread-safe.
absl::Status CheckLabelFormat(std::string_view name, std::string_view bytes);

// What the start of a file among others is.
struct LabelStart {
  bool readable = false;  // a label file with a header that is supported
  // If it is not readable: what is wrong with it, and the remedy; empty for a file of another format, such as a text or
  // a slice of a CT.
  std::string problem;
};

// Tells NIfTI, DICOM Segmentation and RT Structure Set by their first bytes. A NIfTI file with another header, an
// archive, and a file named .nii or .nii.gz that is no NIfTI file have a `problem`. Thread-safe.
LabelStart StartOfLabels(std::string_view name, std::string_view bytes);

// Reads and parses a file. NOT_FOUND names the path, and says so if it is a folder.
absl::StatusOr<LabelVolume> ReadLabels(const std::string& path);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_LABEL_FILE_H_
