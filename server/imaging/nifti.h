// Reads and writes label volumes in NIfTI files, as 3D Slicer and TotalSegmentator write them (format:
// https://nifti.nimh.nih.gov/nifti-1, nifti-2).
//
// A strict reader instead of libnifti: it parses memory, allocates in proportion to the file, and returns an error or a
// valid volume for every truncated or corrupted file. (VTK's reader does not convert RAS to LPS and needs 157 MB.)
#ifndef PHRENIC_SERVER_IMAGING_NIFTI_H_
#define PHRENIC_SERVER_IMAGING_NIFTI_H_

#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "server/imaging/label_volume.h"

namespace phrenic::imaging {

// Parses a single-file NIfTI-1 or NIfTI-2 image, .nii or .nii.gz, of either endianness: one 3D volume of any integer
// type with values 0 to 65,535. The voxel-to-patient map is the sform if present, else the qform, converted from
// NIfTI's RAS to LPS. Label names come from an extension with a table `<Label Key="5" ...>`, as TotalSegmentator writes
// it. INVALID_ARGUMENT "name: ..." or "name:byte N: ..." with problem and remedy; RESOURCE_EXHAUSTED for more than
// `max_voxels`, or more than twice as many bytes. Thread-safe.
absl::StatusOr<LabelVolume> ParseNifti(std::string_view name, std::string_view bytes,
                                       std::size_t max_voxels = kMaxVoxels);

// Returns the length of an uncompressed NIfTI file as the header at its start declares it [bytes]. The errors of
// ParseNifti for this header: one of more voxels is refused before they are read. Thread-safe.
absl::StatusOr<std::size_t> NiftiLength(std::string_view name, std::string_view start, std::size_t max_voxels);

// Returns an uncompressed NIfTI-1 file: uint16 voxels, sform, label names in an extension.
std::string WriteNifti(const LabelVolume& volume);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_NIFTI_H_
