// Numbers in binary files: taken from bytes, and added to them.
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

// Walks over bytes that hold numbers in either byte order, without copying them. Holds views into `bytes`, which must
// outlive it. Not thread-safe.
class ByteReader {
 public:
  ByteReader(std::string_view name, std::string_view bytes, std::size_t at, std::endian order = std::endian::little)
      : name_(name), bytes_(bytes), at_(std::min(at, bytes.size())), order_(order) {}

  // Takes the next number; false, and nothing taken, where fewer bytes are left than it has.
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

  bool Skip(std::size_t count) {
    if (left() < count) return false;
    at_ += count;
    return true;
  }

  std::size_t at() const { return at_; }  // of the next byte, from 0
  std::size_t left() const { return bytes_.size() - at_; }
  // INVALID_ARGUMENT "name:byte N: message", N that of the next byte.
  absl::Status Error(const std::string& message) const {
    return absl::InvalidArgumentError(absl::StrCat(std::string(name_), ":byte ", at_, ": ", message));
  }

 private:
  std::string_view name_;
  std::string_view bytes_;
  std::size_t at_;
  std::endian order_;
};

// Adds the number's bytes, little end first.
template <typename T>
void AppendBytes(std::string& bytes, T number) {
  auto raw = std::bit_cast<std::array<char, sizeof(T)>>(number);
  if (std::endian::native != std::endian::little) std::reverse(raw.begin(), raw.end());
  bytes.append(raw.data(), raw.size());
}

}  // namespace phrenic::meshio

#endif  // PHRENIC_SERVER_MESHIO_BYTES_H_
