// The header of a NIfTI-1 or NIfTI-2 file: size, type and orientation of the volume.
#ifndef PHRENIC_SERVER_IMAGING_NIFTI_HEADER_H_
#define PHRENIC_SERVER_IMAGING_NIFTI_HEADER_H_

#include <Eigen/Geometry>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"

namespace phrenic::imaging {

// Size of the longer header, NIfTI-2's, with the four extension bytes after it.
inline constexpr std::size_t kMaxHeader = 544;

struct NiftiHeader {
  std::endian order = std::endian::little;
  std::size_t length = 0;  // of the header with the four extension bytes
  Eigen::Vector3i size;    // voxels along i, j, k
  int type = 0;            // NIfTI's datatype code
  int voxel_bytes = 0;
  std::size_t data_at = 0;  // byte offset of the first voxel (vox_offset)
  Eigen::Affine3d to_ras;   // voxel index (i, j, k) -> RAS [mm]

  std::size_t voxels() const { return static_cast<std::size_t>(size.x()) * size.y() * size.z(); }
  std::size_t end() const { return data_at + voxels() * voxel_bytes; }
};

// Calls `then` with a zero of the type of NIfTI's datatype code. Returns false if it is not an integer type.
template <typename Then>
bool WithIntegerOf(int type, const Then& then) {
  switch (type) {
    case 2:
      return then(std::uint8_t{}), true;
    case 4:
      return then(std::int16_t{}), true;
    case 8:
      return then(std::int32_t{}), true;
    case 256:
      return then(std::int8_t{}), true;
    case 512:
      return then(std::uint16_t{}), true;
    case 768:
      return then(std::uint32_t{}), true;
    case 1024:
      return then(std::int64_t{}), true;
    case 1280:
      return then(std::uint64_t{}), true;
    default:
      return false;
  }
}

// True if the start of a file has the magic number of NIfTI-1 or NIfTI-2, whatever else the header says.
bool HasNiftiMark(std::string_view start);

// Parses the header from the start of a file. INVALID_ARGUMENT "name:byte N: ..." if it is not that of a label volume.
absl::StatusOr<NiftiHeader> ParseNiftiHeader(std::string_view name, std::string_view bytes);

inline const Eigen::Vector3d kRasToLps(-1, -1, 1);

// What a NIfTI-1 header of one file says.
struct NiftiLayout {
  std::array<int, 8> dimensions;  // their number, then their sizes
  Eigen::Vector3d spacing;        // [mm]
  Eigen::Affine3d to_patient;     // voxel index (i, j, k) -> LPS [mm]
  int intent;                     // NIfTI's intent code
  int type, bits;                 // NIfTI's datatype code, bits of a number
  std::size_t extension;          // bytes of the extension that follows; 0: none
};

// Returns the header and the four bytes after it, little-endian.
std::string NiftiHeaderBytes(const NiftiLayout& layout);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_NIFTI_HEADER_H_
