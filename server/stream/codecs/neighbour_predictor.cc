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
  explicit Parts(std::size_t count) { bits.reserve((count + 3) / 4); }
  void Add(std::int32_t remainder) {
    const std::uint32_t value = ZigZag(remainder);
    const std::uint32_t two = std::min(value, kEscape);
    open |= two << shift;
    shift += 2;
    if (shift == 8) End();
    if (two == kEscape) AppendNumber(value - kEscape, overflow);
  }
  // Ends the byte that is open, if one is.
  void End() {
    if (shift > 0) bits += static_cast<char>(open);
    open = shift = 0;
  }
  std::string bits, overflow;
  std::uint32_t open = 0;
  int shift = 0;  // [bits]
};

}  // namespace

Steps NeighbourPredictor::Residuals(const Steps& steps) const {
  Steps residuals(steps.size());
  SetResiduals(neighbours_, steps, residuals);
  return residuals;
}

void AppendResiduals(const Steps& residuals, std::string& bytes) {
  Parts parts(residuals.size());
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = axis; i < residuals.size(); i += 3) parts.Add(residuals[i]);
  }
  parts.End();
  std::string compressed;
  const std::size_t first = AppendCompressed(parts.bits, compressed);
  AppendCompressed(parts.overflow, compressed);
  Append(static_cast<std::uint32_t>(first), bytes);
  Append(static_cast<std::uint32_t>(parts.overflow.size()), bytes);
  bytes += compressed;
}

}  // namespace phrenic::stream
