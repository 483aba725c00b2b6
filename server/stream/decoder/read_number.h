// Little-endian numbers of the wire format (proto/README.md), read from bytes.
#ifndef PHRENIC_SERVER_STREAM_DECODER_READ_NUMBER_H_
#define PHRENIC_SERVER_STREAM_DECODER_READ_NUMBER_H_

#include <bit>
#include <cstddef>
#include <cstring>
#include <string_view>

namespace phrenic::stream {

// Numbers are copied without conversion.
static_assert(std::endian::native == std::endian::little, "the wire is little-endian: swap the bytes here");

// Returns the number at `offset`. Requires: offset + sizeof(Number) <= bytes.size().
template <class Number>
Number Read(std::string_view bytes, std::size_t offset) {
  Number value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_DECODER_READ_NUMBER_H_
