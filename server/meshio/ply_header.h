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
enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::kFloat32;
  bool list = false;
  PlyType count_type = PlyType::kUint8;  // type of a list's length
};

struct PlyElement {
  std::string name;
  std::int64_t count = 0;  // rows, as declared
  std::vector<PlyProperty> properties;

  // Returns the index of the property, or -1.
  int Find(std::string_view property) const;
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::kText;
  Frame frame = Frame::kUnspecified;
  std::vector<PlyElement> elements;  // exactly one is named "vertex", with scalar properties x, y and z
};

// Reads from the start of the file through the line "end_header". INVALID_ARGUMENT "name:line: ...".
absl::StatusOr<PlyHeader> ReadPlyHeader(TextReader& reader);

}  // namespace phrenic::meshio

#endif  // PHRENIC_SERVER_MESHIO_PLY_HEADER_H_
