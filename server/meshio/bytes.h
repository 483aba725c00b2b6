// Reads and writes binary numbers of either endianness.
#ifndef PHRENIC_SERVER_MESHIO_BYTES_H_
#define PHRENIC_SERVER_MESHIO_BYTES_H_

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"

namespace phrenic::meshio {

// A cursor over binary data that decodes numbers without copying the data. Holds views into `name` and `bytes`, which
// must outlive it. Not thread-safe. The parsers of binary STL, PLY, MSH and VTK use it.
class ByteReader {
 public:
  // `name` is the file's, for errors. An `at` behind the end counts as the end.
  ByteReader(std::string_view name, std::string_view bytes, std::size_t at, std::endian order = std::endian::little)
      : name_(name), bytes_(bytes), at_(std::min(at, bytes.size())), order_(order) {}

  // Reads the next number. Returns false and reads nothing if fewer than sizeof(T) bytes are left.
  template <typename T>
  bool Take(T& number) {
    std::array<char, sizeof(T)> raw;
    if (left() < raw.size()) return false;
    std::memcpy(raw.data(), bytes_.data() + at_, raw.size());
    if (order_ != std::endian::native) std::reverse(raw.begin(), raw.end());
    number = std::bit_cast<T>(raw);
    at_ += raw.size();
    return true;
  }

  // Moves over `count` bytes. Returns false and moves nowhere if fewer are left.
  bool Skip(std::size_t count) {
    if (left() < count) return false;
    at_ += count;
    return true;
  }

  std::size_t at() const { return at_; }                    // offset of the next byte
  std::size_t left() const { return bytes_.size() - at_; }  // bytes
  // Returns INVALID_ARGUMENT "name:byte N: message", N the offset of the next byte.
  absl::Status Error(const std::string& message) const {
    return absl::InvalidArgumentError(absl::StrCat(std::string(name_), ":byte ", at_, ": ", message));
  }

 private:
  std::string_view name_;
  std::string_view bytes_;
  std::size_t at_;
  std::endian order_;  // of the file
};

// Appends the number in little-endian byte order.
template <typename T>
void AppendBytes(std::string& bytes, T number) {
  auto raw = std::bit_cast<std::array<char, sizeof(T)>>(number);
  if (std::endian::native != std::endian::little) std::reverse(raw.begin(), raw.end());
  bytes.append(raw.data(), raw.size());
}

}  // namespace phrenic::meshio

#endif  // PHRENIC_SERVER_MESHIO_BYTES_H_
