#include "server/stream/codecs/neighbour_predictor.h"

#include <optional>

#include "absl/strings/str_cat.h"
#include "server/stream/codecs/wire.h"
#include "server/stream/codecs/zstd.h"

namespace phrenic::stream {
namespace {

constexpr std::uint32_t kEscape = 3;       // of two bits: the number continues in the overflow
constexpr std::size_t kLengths = 8;        // bytes of the first zstd frame, bytes of the overflow
constexpr std::size_t kLongestNumber = 5;  // bytes of the overflow

absl::Status Bad(const char* what) { return absl::InvalidArgumentError(absl::StrCat("residuals: ", what)); }

// Zigzag encoding: 0, -1, 1, -2, ... as 0, 1, 2, 3, ...
std::uint32_t ZigZag(std::int32_t value) {
  return (static_cast<std::uint32_t>(value) << 1) ^ static_cast<std::uint32_t>(value >> 31);
}

std::int32_t UnZigZag(std::uint32_t value) { return static_cast<std::int32_t>((value >> 1) ^ (0U - (value & 1))); }

// Varint: seven bits per byte, low bits first, the eighth bit set if more follow.
void AppendNumber(std::uint32_t value, std::string& bytes) {
  for (; value >= 0x80; value >>= 7) bytes += static_cast<char>(value | 0x80);
  bytes += static_cast<char>(value);
}

// Nothing if the bytes end within the number.
std::optional<std::uint32_t> TakeNumber(std::string_view bytes, std::size_t& at) {
  std::uint32_t value = 0;
  for (int shift = 0; shift < 35 && at < bytes.size(); shift += 7) {
    const auto byte = static_cast<unsigned char>(bytes[at++]);
    value |= static_cast<std::uint32_t>(byte & 0x7f) << shift;
    if (byte < 0x80) return value;
  }
  return std::nullopt;
}

// Residuals in two parts: two bits each, four per byte from the low bits, and the overflow of those with kEscape.
struct Parts {
  explicit Parts(std::size_t count) : bits((count + 3) / 4, '\0') {}
  void Add(std::int32_t remainder) {
    const std::uint32_t value = ZigZag(remainder);
    const std::uint32_t two = std::min(value, kEscape);
    bits[next / 4] = static_cast<char>(static_cast<unsigned char>(bits[next / 4]) | two << 2 * (next % 4));
    ++next;
    if (two == kEscape) AppendNumber(value - kEscape, overflow);
  }
  std::string bits, overflow;
  std::size_t next = 0;
};

// Three per place.
std::optional<Steps> Join(std::string_view bits, std::string_view overflow, std::size_t places) {
  Steps residuals(3 * places);
  std::size_t at = 0, i = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t place = 0; place < places; ++place, ++i) {
      std::uint32_t value = static_cast<unsigned char>(bits[i / 4]) >> 2 * (i % 4) & 3;
      if (value == kEscape) {
        const auto more = TakeNumber(overflow, at);
        if (!more.has_value()) return std::nullopt;
        value += *more;
      }
      residuals[3 * place + axis] = UnZigZag(value);
    }
  }
  if (at != overflow.size()) return std::nullopt;
  return residuals;
}

}  // namespace

std::array<std::int64_t, 3> NeighbourPredictor::Predict(const Steps& steps, int place) const {
  static_assert(kUnit == 1 << 12);
  std::int64_t x = kUnit / 2, y = kUnit / 2, z = kUnit / 2;
  for (int i = neighbours_.first[place]; i < neighbours_.first[place + 1]; ++i) {
    const std::int64_t weight = neighbours_.weights[i];
    const std::int32_t* const other = &steps[3 * static_cast<std::size_t>(neighbours_.places[i])];
    x += weight * other[0], y += weight * other[1], z += weight * other[2];
  }
  return {x >> 12, y >> 12, z >> 12};  // over kUnit, rounded down
}

Steps NeighbourPredictor::Residuals(const Steps& steps) const {
  Steps residuals(steps.size());
  for (int place = 0; 3 * static_cast<std::size_t>(place) < steps.size(); ++place) {
    const auto foretold = Predict(steps, place);
    for (int axis = 0; axis < 3; ++axis) {
      residuals[3 * place + axis] = static_cast<std::int32_t>(steps[3 * place + axis] - foretold[axis]);
    }
  }
  return residuals;
}

Steps NeighbourPredictor::Sums(const Steps& residuals) const {
  Steps steps(residuals.size());
  for (int place = 0; 3 * static_cast<std::size_t>(place) < steps.size(); ++place) {
    const auto foretold = Predict(steps, place);
    for (int axis = 0; axis < 3; ++axis) {
      steps[3 * place + axis] = static_cast<std::int32_t>(foretold[axis] + residuals[3 * place + axis]);
    }
  }
  return steps;
}

void AppendResiduals(const Steps& residuals, std::string& bytes) {
  Parts parts(residuals.size());
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = axis; i < residuals.size(); i += 3) parts.Add(residuals[i]);
  }
  std::string compressed;
  const std::size_t first = AppendCompressed(parts.bits, compressed);
  AppendCompressed(parts.overflow, compressed);
  Append(static_cast<std::uint32_t>(first), bytes);
  Append(static_cast<std::uint32_t>(parts.overflow.size()), bytes);
  bytes += compressed;
}

absl::StatusOr<Steps> ReadResiduals(std::string_view bytes, std::size_t places) {
  if (bytes.size() < kLengths) return Bad("the lengths are cut off");
  const std::size_t first = Read<std::uint32_t>(bytes, 0), overflow_bytes = Read<std::uint32_t>(bytes, 4);
  const std::size_t count = 3 * places;
  if (first > bytes.size() - kLengths) return Bad("the two bits are cut off");
  if (overflow_bytes > kLongestNumber * count) return Bad("there is more overflow than there are numbers");
  const auto bits = Decompress(bytes.substr(kLengths, first), (count + 3) / 4);
  if (!bits.ok()) return bits.status();
  const auto overflow = Decompress(bytes.substr(kLengths + first), overflow_bytes);
  if (!overflow.ok()) return overflow.status();
  auto residuals = Join(*bits, *overflow, places);
  if (!residuals.has_value()) return Bad("the overflow does not fit the two bits");
  return *std::move(residuals);
}

}  // namespace phrenic::stream
