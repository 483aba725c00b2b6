// The header of a PLY file: the encoding and layout of its body.
#ifndef PHRENIC_SERVER_MESHIO_PLY_HEADER_H_
#define PHRENIC_SERVER_MESHIO_PLY_HEADER_H_

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "server/meshio/formats.h"
#include "server/meshio/text.h"

namespace phrenic::meshio {

enum class PlyEncoding { kText, kLittleEndian, kBigEndian };
// The header names each by either of two words, such as "char" and "int8".
enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::kFloat32;
  bool list = false;
  PlyType count_type = PlyType::kUint8;  // type of a list's length
};

// An element without properties is refused, since the file could claim any number of them.
struct PlyElement {
  std::string name;
  std::int64_t count = 0;  // rows, as declared; 0 to INT_MAX
  std::vector<PlyProperty> properties;

  // Returns the index of the property, or -1.
  int Find(std::string_view property) const;
};

// Plain data, in the file's order.
struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::kText;
  Frame frame = Frame::kUnspecified;  // of the comments
  std::vector<PlyElement> elements;   // exactly one is named "vertex", with scalar properties x, y and z
};

// Reads from the start of the file through the line "end_header". INVALID_ARGUMENT "name:line: ...". The body starts at
// reader.next_line().
absl::StatusOr<PlyHeader> ReadPlyHeader(TextReader& reader);

}  // namespace phrenic::meshio

#endif  // PHRENIC_SERVER_MESHIO_PLY_HEADER_H_
