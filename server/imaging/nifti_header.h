// What the header of a NIfTI file says: how many voxels of which type there are, and where they lie.
#ifndef PHRENIC_SERVER_IMAGING_NIFTI_HEADER_H_
#define PHRENIC_SERVER_IMAGING_NIFTI_HEADER_H_

#include <Eigen/Geometry>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "absl/status/statusor.h"

namespace phrenic::imaging {

// The header and the four bytes after it, of the longer of the two versions.
inline constexpr std::size_t kLongestHeader = 544;

struct NiftiHeader {
  std::endian order = std::endian::little;
  std::size_t length = 0;  // of the header with the four bytes that tell of extensions
  Eigen::Vector3i size;    // voxels along i, j, k
  int type = 0;            // NIfTI's code
  int voxel_bytes = 0;
  std::size_t data_at = 0;  // of the first voxel
  Eigen::Affine3d to_ras;   // (i, j, k) to [mm] in NIfTI's own frame

  std::size_t voxels() const { return static_cast<std::size_t>(size.x()) * size.y() * size.z(); }
  std::size_t end() const { return data_at + voxels() * voxel_bytes; }
};

// Calls `then` with a number of the type that NIfTI's code tells; false where it is no integer type.
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

// INVALID_ARGUMENT "name:byte N: ..." where `bytes`, the beginning of a file, are no header of a label volume.
absl::StatusOr<NiftiHeader> ParseNiftiHeader(std::string_view name, std::string_view bytes);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_NIFTI_HEADER_H_
