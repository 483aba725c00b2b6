// Label volumes in NIfTI files, as 3D Slicer and TotalSegmentator write them.
//
// A strict reader of our own rather than Debian's libnifti: it reads from bytes, takes no more memory than the file can
// hold, and every cut and every flipped byte gives an error or a volume. (VTK's reader does not turn RAS to LPS, and
// would bring 157 MB along.) Format: https://nifti.nimh.nih.gov/nifti-1, nifti-2.
#ifndef PHRENIC_SERVER_IMAGING_NIFTI_H_
#define PHRENIC_SERVER_IMAGING_NIFTI_H_

#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "server/imaging/label_volume.h"

namespace phrenic::imaging {

// Parses a single-file NIfTI-1 or NIfTI-2 image (.nii), as it is or in gzip (.nii.gz), of either byte order: one volume
// of any integer type, every value 0 to 65,535. The sform says where it lies, else the qform; NIfTI's frame is RAS, the
// volume's is LPS. Names of labels come from an extension with a table `<Label Key="5"...>`, as TotalSegmentator writes
// it. INVALID_ARGUMENT "name: ..." or "name:byte N: ..." says what is wrong and what to do.
absl::StatusOr<LabelVolume> ParseNifti(std::string_view name, std::string_view bytes);

// Reads the file and parses it; NOT_FOUND names the path.
absl::StatusOr<LabelVolume> ReadNifti(const std::string& path);

// The bytes of a NIfTI-1 file of unsigned 16-bit numbers, with the names of labels in an extension; not compressed.
std::string WriteNifti(const LabelVolume& volume);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_NIFTI_H_
