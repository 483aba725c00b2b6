// Decodes the data arrays of VTK XML files: text, base64 or appended raw data, uncompressed or zlib (VTK File Formats,
// "XML File Formats").
#ifndef PHRENIC_SERVER_MESHIO_VTK_ARRAYS_H_
#define PHRENIC_SERVER_MESHIO_VTK_ARRAYS_H_

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"

namespace phrenic::meshio {

// Encoding attributes of a file, common to its arrays. The view refers to the file, which must outlive it.
struct VtkEncoding {
  bool wide_header = false;  // header_type is UInt64 instead of UInt32
  bool compressed = false;   // by zlib
  std::endian order = std::endian::little;
  std::string_view appended;  // the data after the "_" of AppendedData
  bool appended_base64 = false;
  std::size_t max_unpacked = 0;  // maximum uncompressed size of an array [bytes]
};

// The attributes and text of a DataArray element. Views of the XML document, which must outlive it.
struct VtkArray {
  std::string_view type;    // "Float32"
  std::string_view format;  // "ascii", "binary", "appended"
  std::string_view text;    // data of "ascii" and "binary"
  std::string_view offset;  // byte offset of "appended"
};

// Return the numbers of a Float32 or Float64 array, all finite, and of an array of any integer type. Errors are
// INVALID_ARGUMENT with the sentence alone; the parser adds the position. Thread-safe. UInt64 is read as Int64.
// INVALID_ARGUMENT for another type, damaged or truncated data, excess bytes, and a declared size above max_unpacked,
// which is checked before memory is allocated.
absl::StatusOr<std::vector<double>> ReadDoubles(const VtkArray& array, const VtkEncoding& encoding);
absl::StatusOr<std::vector<std::int64_t>> ReadIntegers(const VtkArray& array, const VtkEncoding& encoding);

}  // namespace phrenic::meshio

#endif  // PHRENIC_SERVER_MESHIO_VTK_ARRAYS_H_
