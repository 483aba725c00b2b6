// Readers of bits for Zstandard (RFC 8878, 4.1 and 4.2.2). Neither reads outside of its bytes.
#ifndef PHRENIC_SERVER_STREAM_DECODER_ZSTD_BITS_H_
#define PHRENIC_SERVER_STREAM_DECODER_ZSTD_BITS_H_

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>

namespace phrenic::stream {

using ByteSpan = std::span<const std::uint8_t>;

// Reads from the first byte on, low bits first. Beyond the end all bits are 0; `bits_read` tells.
class ForwardBits {
 public:
  explicit ForwardBits(ByteSpan bytes) : bytes_(bytes) {}

  // Returns the next `count` bits. Requires: count <= 16.
  std::uint32_t Read(unsigned count) {
    std::uint32_t window = 0;
    for (std::size_t i = 0; i < 3 && bits_ / 8 + i < bytes_.size(); ++i) {
      window |= static_cast<std::uint32_t>(bytes_[bits_ / 8 + i]) << 8 * i;
    }
    const std::uint32_t value = window >> bits_ % 8 & ((1U << count) - 1);
    bits_ += count;
    return value;
  }
  void Unread(unsigned count) { bits_ -= count; }
  // Number of bytes of which bits were read; above the size if bits beyond the end were.
  std::size_t bytes_read() const { return (bits_ + 7) / 8; }

 private:
  ByteSpan bytes_;
  std::size_t bits_ = 0;
};

// Reads from the last byte back, high bits first; the highest set bit of the last byte only marks the end. Bits are
// valid while not Overflowed(). Call Reload() at least once for 56 bits.
class BackwardBits {
 public:
  BackwardBits() = default;
  // False if the bytes have no end mark.
  bool Start(ByteSpan bytes) {
    if (bytes.empty() || bytes.back() == 0) return false;
    start_ = bytes.data();
    read_ = static_cast<unsigned>(std::countl_zero(bytes.back())) + 1;
    if (bytes.size() >= 8) {
      at_ = bytes.data() + bytes.size() - 8;
      std::memcpy(&window_, at_, 8);
      return true;
    }
    at_ = start_;
    window_ = 0;
    std::memcpy(&window_, start_, bytes.size());
    read_ += static_cast<unsigned>(8 * (8 - bytes.size()));
    return true;
  }
  // Returns the next `count` bits without taking them. Requires: count <= 32.
  std::uint32_t Peek(unsigned count) const {
    return static_cast<std::uint32_t>(window_ << (read_ & 63) >> 1 >> (63 - count));
  }
  void Take(unsigned count) { read_ += count; }
  std::uint32_t Read(unsigned count) {
    const std::uint32_t value = Peek(count);
    read_ += count;
    return value;
  }
  void Reload() {
    if (Overflowed() || at_ == start_) return;
    const std::size_t room = static_cast<std::size_t>(at_ - start_);
    const std::size_t bytes = read_ / 8 < room ? read_ / 8 : room;
    at_ -= bytes;
    read_ -= static_cast<unsigned>(8 * bytes);
    std::memcpy(&window_, at_, 8);
  }
  // True if more bits were taken than there are.
  bool Overflowed() const { return read_ > 64; }
  // True if exactly all bits were taken. Requires: Reload() was called after the last bit was taken.
  bool Finished() const { return at_ == start_ && read_ == 64; }

 private:
  const std::uint8_t* start_ = nullptr;
  const std::uint8_t* at_ = nullptr;
  std::uint64_t window_ = 0;
  unsigned read_ = 64;  // bits of `window_` that were taken
};

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_DECODER_ZSTD_BITS_H_
