#include "server/stream/decoder/residuals.h"

#include <algorithm>
#include <array>

#include "server/stream/decoder/read_number.h"

namespace phrenic::stream {
namespace {

constexpr std::uint32_t kOverflowCode = 3;  // of two bits: the number continues in the overflow
constexpr std::size_t kLengths = 8;         // bytes of the first zstd frame, bytes of the overflow
constexpr std::size_t kLongestNumber = 5;   // bytes of the overflow

// Zigzag encoding: 0, -1, 1, -2, ... as 0, 1, 2, 3, ...
std::int32_t UnZigZag(std::uint32_t value) { return static_cast<std::int32_t>((value >> 1) ^ (0U - (value & 1))); }

constexpr std::array<std::int32_t, 3> kSmall = {0, -1, 1};

// Numbers of seven bits per byte, low bits first, the eighth bit set if more follow.
class Varints {
 public:
  explicit Varints(const std::vector<std::uint8_t>& bytes) : at_(bytes.data()), end_(at_ + bytes.size()) {}
  // 0 after an error.
  std::uint32_t Take() {
    std::uint32_t value = 0;
    for (unsigned shift = 0; shift < 7 * kLongestNumber && at_ < end_; shift += 7) {
      const std::uint32_t byte = *at_++;
      value |= (byte & 0x7f) << shift;
      if (byte < 0x80) return value;
    }
    failed_ = true;
    return 0;
  }
  // True if the numbers taken are exactly those of the bytes.
  bool Finished() const { return !failed_ && at_ == end_; }

 private:
  const std::uint8_t* at_;
  const std::uint8_t* const end_;
  bool failed_ = false;
};

}  // namespace

const char* ResidualReader::Read(std::string_view bytes, std::size_t places, ZstdDecoder& zstd) {
  if (bytes.size() < kLengths) return "residuals: the lengths are cut off";
  const std::size_t first = stream::Read<std::uint32_t>(bytes, 0), more = stream::Read<std::uint32_t>(bytes, 4);
  const std::size_t count = 3 * places;
  if (first > bytes.size() - kLengths) return "residuals: the two bits are cut off";
  if (more > kLongestNumber * count) return "residuals: there is more overflow than there are numbers";
  places_ = places;
  pairs_.resize((count + 3) / 4);
  overflow_.resize(more);
  if (const char* problem = zstd.Decompress(bytes.substr(kLengths, first), pairs_)) return problem;
  return zstd.Decompress(bytes.substr(kLengths + first), overflow_);
}

const char* ResidualReader::Unpack(PaddedSteps& steps) const {
  steps.assign(4 * places_, 0);
  if (places_ == 0) return nullptr;
  Varints overflow(overflow_);
  std::size_t i = 0;  // residuals before: all x first
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::int32_t* to = steps.data() + axis;
    const auto put = [&](std::uint32_t code) {
      *to = code == kOverflowCode ? UnZigZag(kOverflowCode + overflow.Take()) : kSmall[code];
      to += 4, ++i;
    };
    const std::size_t end = (axis + 1) * places_;
    while (i < end && i % 4 != 0) put(pairs_[i / 4] >> 2 * (i % 4) & 3U);
    while (i + 4 <= end) {
      std::uint32_t four = pairs_[i / 4];
      if (four == 0) {
        to += 16, i += 4;
        continue;
      }
      for (int k = 0; k < 4; ++k, four >>= 2) put(four & 3);
    }
    while (i < end) put(pairs_[i / 4] >> 2 * (i % 4) & 3U);
  }
  return overflow.Finished() ? nullptr : "residuals: the overflow does not fit the two bits";
}

}  // namespace phrenic::stream
