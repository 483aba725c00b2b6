// The header of a PLY file: what its body holds and how.
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
  PlyType count_type = PlyType::kUint8;  // of a list
};

struct PlyElement {
  std::string name;
  std::int64_t count = 0;  // as the file claims
  std::vector<PlyProperty> properties;

  // The property's place, or -1.
  int Find(std::string_view property) const;
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::kText;
  Frame frame = Frame::kUnsaid;
  std::vector<PlyElement> elements;  // one at least is called "vertex"
};

// Reads from the start of the file up to and with the line "end_header". INVALID_ARGUMENT names the line.
absl::StatusOr<PlyHeader> ReadPlyHeader(TextReader& reader);

}  // namespace phrenic::meshio

#endif  // PHRENIC_SERVER_MESHIO_PLY_HEADER_H_
