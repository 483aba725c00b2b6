// Numbers as they travel: little-endian (proto/README.md).
#ifndef PHRENIC_SERVER_STREAM_WIRE_H_
#define PHRENIC_SERVER_STREAM_WIRE_H_

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "server/mesh/mesh.h"

namespace phrenic::stream {

// Numbers are copied as the machine has them, so the machine must have them as the wire does.
static_assert(std::endian::native == std::endian::little, "the wire is little-endian: swap the bytes here");

// float32 x y z a column.
inline void AppendFloats(const Eigen::Ref<const Eigen::MatrixXf>& values, std::string& bytes) {
  bytes.append(reinterpret_cast<const char*>(values.data()), sizeof(float) * values.size());
}

// uint32 an index, column after column.
inline void AppendIndices(const Eigen::Ref<const Eigen::MatrixXi>& indices, std::string& bytes) {
  static_assert(sizeof(int) == sizeof(std::uint32_t));
  bytes.append(reinterpret_cast<const char*>(indices.data()), sizeof(int) * indices.size());
}

template <class Number>
void Append(Number value, std::string& bytes) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

inline void AppendIndex(int index, std::string& bytes) { Append(static_cast<std::uint32_t>(index), bytes); }

// The number that begins at `offset`; the bytes do not end before it does.
template <class Number>
Number Read(std::string_view bytes, std::size_t offset) {
  Number value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_WIRE_H_
