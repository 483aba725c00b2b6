// Little-endian numbers of the wire format (proto/README.md).
#ifndef PHRENIC_SERVER_STREAM_CODECS_WIRE_H_
#define PHRENIC_SERVER_STREAM_CODECS_WIRE_H_

#include <cstdint>
#include <string>
#include <vector>

#include "server/mesh/mesh.h"
#include "server/stream/decoder/read_number.h"

namespace phrenic::stream {

// Appends x, y, z of each column as float32.
inline void AppendFloats(const Eigen::Ref<const Eigen::MatrixXf>& values, std::string& bytes) {
  bytes.append(reinterpret_cast<const char*>(values.data()), sizeof(float) * values.size());
}

// Returns the numbers as float64, column by column.
inline std::string DoublesOf(const Eigen::Ref<const Eigen::MatrixXd>& values) {
  return {reinterpret_cast<const char*>(values.data()), sizeof(double) * values.size()};
}

// Appends indices as uint32, column by column.
inline void AppendIndices(const Eigen::Ref<const Eigen::MatrixXi>& indices, std::string& bytes) {
  static_assert(sizeof(int) == sizeof(std::uint32_t));
  bytes.append(reinterpret_cast<const char*>(indices.data()), sizeof(int) * indices.size());
}

// Appends the bytes of a number, of 4 or 8 bytes in the formats here.
template <class Number>
void Append(Number value, std::string& bytes) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

inline void AppendIndex(int index, std::string& bytes) { Append(static_cast<std::uint32_t>(index), bytes); }

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_CODECS_WIRE_H_
