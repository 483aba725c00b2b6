// The numbers of a data array of VTK's XML files: in text, in base64, or as bytes at the file's end.
#ifndef PHRENIC_SERVER_MESHIO_VTK_ARRAYS_H_
#define PHRENIC_SERVER_MESHIO_VTK_ARRAYS_H_

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"

namespace phrenic::meshio {

// What the whole file says of its arrays.
struct VtkEncoding {
  bool wide_header = false;  // UInt64, not UInt32
  bool compressed = false;   // by zlib
  std::endian order = std::endian::little;
  std::string_view appended;  // behind the "_" of AppendedData
  bool appended_base64 = false;
  std::size_t most_bytes = 0;  // that an array may unpack to
};

// One DataArray.
struct VtkArray {
  std::string_view type;    // "Float32"
  std::string_view format;  // "ascii", "binary", "appended"
  std::string_view text;    // of "ascii" and "binary"
  std::string_view offset;  // of "appended"
};

// Statuses have the sentence alone, for the reader to say where. Coordinates are finite; whole numbers of every integer
// type are read.
absl::StatusOr<std::vector<double>> ReadDoubles(const VtkArray& array, const VtkEncoding& encoding);
absl::StatusOr<std::vector<std::int64_t>> ReadIntegers(const VtkArray& array, const VtkEncoding& encoding);

}  // namespace phrenic::meshio

#endif  // PHRENIC_SERVER_MESHIO_VTK_ARRAYS_H_
