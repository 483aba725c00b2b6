#include "server/stream/codecs/neighbour_predictor.h"

#include <algorithm>

#include "server/stream/codecs/wire.h"
#include "server/stream/codecs/zstd.h"

namespace phrenic::stream {
namespace {

constexpr std::uint32_t kEscape = 3;  // of two bits: the number continues in the overflow

// Zigzag encoding: 0, -1, 1, -2, ... as 0, 1, 2, 3, ...
std::uint32_t ZigZag(std::int32_t value) {
  return (static_cast<std::uint32_t>(value) << 1) ^ static_cast<std::uint32_t>(value >> 31);
}

// Varint: seven bits per byte, low bits first, the eighth bit set if more follow.
void AppendNumber(std::uint32_t value, std::string& bytes) {
  for (; value >= 0x80; value >>= 7) bytes += static_cast<char>(value | 0x80);
  bytes += static_cast<char>(value);
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
    const auto predicted = Predict(steps, place);
    for (int axis = 0; axis < 3; ++axis) {
      residuals[3 * place + axis] = static_cast<std::int32_t>(steps[3 * place + axis] - predicted[axis]);
    }
  }
  return residuals;
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

}  // namespace phrenic::stream
