#include "server/stream/codecs/predicted.h"

#include <optional>

#include "absl/strings/str_cat.h"
#include "server/stream/quantise.h"
#include "server/stream/wire.h"
#include "server/stream/zstd.h"

namespace phrenic::stream {
namespace {

constexpr std::uint32_t kEscape = 3;       // of two bits: the rest follows in the overflow
constexpr double kFurthest = 1 << 30;      // [steps] from rest
constexpr std::size_t kHeadBytes = 16;     // step float64, bytes of the first zstd frame, bytes of the overflow
constexpr std::size_t kLongestNumber = 5;  // bytes of the overflow

absl::Status Bad(std::string_view what) {
  return absl::InvalidArgumentError(absl::StrCat("predicted: ", std::string(what)));
}

// 0, -1, 1, -2, ... as 0, 1, 2, 3, ...
std::uint32_t ZigZag(std::int32_t value) {
  return (static_cast<std::uint32_t>(value) << 1) ^ static_cast<std::uint32_t>(value >> 31);
}

std::int32_t UnZigZag(std::uint32_t value) { return static_cast<std::int32_t>((value >> 1) ^ (0U - (value & 1))); }

// Seven bits a byte, the low ones first, the eighth set where more follow.
void AppendNumber(std::uint32_t value, std::string& bytes) {
  for (; value >= 0x80; value >>= 7) bytes += static_cast<char>(value | 0x80);
  bytes += static_cast<char>(value);
}

// None where the bytes end before the number does.
std::optional<std::uint32_t> TakeNumber(std::string_view bytes, std::size_t& at) {
  std::uint32_t value = 0;
  for (int shift = 0; shift < 35 && at < bytes.size(); shift += 7) {
    const auto byte = static_cast<unsigned char>(bytes[at++]);
    value |= static_cast<std::uint32_t>(byte & 0x7f) << shift;
    if (byte < 0x80) return value;
  }
  return std::nullopt;
}

// The remainders in two parts: two bits each, four a byte from the low bits, and what is left of those of kEscape.
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

std::optional<std::vector<std::int32_t>> Join(std::string_view bits, std::string_view overflow, std::size_t count) {
  std::vector<std::int32_t> remainders(count);
  std::size_t at = 0;
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t value = static_cast<unsigned char>(bits[i / 4]) >> 2 * (i % 4) & 3;
    if (value == kEscape) {
      const auto more = TakeNumber(overflow, at);
      if (!more.has_value()) return std::nullopt;
      value += *more;
    }
    remainders[i] = UnZigZag(value);
  }
  if (at != overflow.size()) return std::nullopt;
  return remainders;
}

Floats InOrder(const Floats& values, const std::vector<int>& order) {
  Floats ordered(3, values.cols());
  for (std::size_t i = 0; i < order.size(); ++i) ordered.col(static_cast<Eigen::Index>(i)) = values.col(order[i]);
  return ordered;
}

}  // namespace

PredictedCodec::PredictedCodec(const RestShape& shape)
    : neighbours_(MakeNeighbourWeights(shape)), rest_(InOrder(shape.rest, neighbours_.order)) {}

std::array<std::int64_t, 3> PredictedCodec::Foretell(const Displacements& displacements, int place) const {
  static_assert(kUnit == 1 << 12);
  std::int64_t x = kUnit / 2, y = kUnit / 2, z = kUnit / 2;
  for (int i = neighbours_.first[place]; i < neighbours_.first[place + 1]; ++i) {
    const std::int64_t weight = neighbours_.weights[i];
    const std::int32_t* const other = &displacements[3 * static_cast<std::size_t>(neighbours_.places[i])];
    x += weight * other[0], y += weight * other[1], z += weight * other[2];
  }
  return {x >> 12, y >> 12, z >> 12};  // over kUnit, rounded down
}

absl::StatusOr<std::string> PredictedCodec::Encode(const Floats& positions, double max_error) const {
  const auto step = GridStep(positions, max_error);
  if (!step.has_value() || !IsGridStep(*step)) return absl::OutOfRangeError("the bound is finer than float32");
  const int vertices = static_cast<int>(rest_.cols());
  Displacements displacements(static_cast<std::size_t>(rest_.size()));
  const double inverse = 1 / *step;
  for (int place = 0; place < vertices; ++place) {
    const int vertex = neighbours_.order[place];
    for (int axis = 0; axis < 3; ++axis) {
      const double moved = static_cast<double>(positions(axis, vertex)) - static_cast<double>(rest_(axis, place));
      const double steps = std::floor(moved * inverse + 0.5);
      if (!(std::abs(steps) <= kFurthest)) return absl::OutOfRangeError("a vertex is too far from rest");
      displacements[3 * place + axis] = static_cast<std::int32_t>(steps);
    }
  }
  Displacements remainders(displacements.size());  // all x first
  for (int place = 0; place < vertices; ++place) {
    const auto foretold = Foretell(displacements, place);
    for (int axis = 0; axis < 3; ++axis) {  // modulo 2^32, as it is added
      remainders[axis * vertices + place] = static_cast<std::int32_t>(displacements[3 * place + axis] - foretold[axis]);
    }
  }
  Parts parts(remainders.size());
  for (const std::int32_t remainder : remainders) parts.Add(remainder);
  std::string bytes, compressed;
  const std::size_t first = AppendCompressed(parts.bits, compressed);
  AppendCompressed(parts.overflow, compressed);
  Append(*step, bytes);
  Append(static_cast<std::uint32_t>(first), bytes);
  Append(static_cast<std::uint32_t>(parts.overflow.size()), bytes);
  return bytes + compressed;
}

absl::StatusOr<Floats> PredictedCodec::Decode(std::string_view bytes) const {
  if (bytes.size() < kHeadBytes) return Bad("the head is cut off");
  const double step = Read<double>(bytes, 0);
  const std::size_t first = Read<std::uint32_t>(bytes, 8), overflow_bytes = Read<std::uint32_t>(bytes, 12);
  const auto count = static_cast<std::size_t>(rest_.size());
  if (!IsGridStep(step)) return Bad("the step is not within 0 to 1 m");
  if (first > bytes.size() - kHeadBytes) return Bad("the two bits are cut off");
  if (overflow_bytes > kLongestNumber * count) return Bad("there is more overflow than there are numbers");
  const auto bits = Decompress(bytes.substr(kHeadBytes, first), (count + 3) / 4);
  if (!bits.ok()) return bits.status();
  const auto overflow = Decompress(bytes.substr(kHeadBytes + first), overflow_bytes);
  if (!overflow.ok()) return overflow.status();
  const auto remainders = Join(*bits, *overflow, count);
  if (!remainders.has_value()) return Bad("the overflow does not fit the two bits");
  Displacements displacements(count);
  Floats positions(3, rest_.cols());
  for (int place = 0; place < static_cast<int>(rest_.cols()); ++place) {
    const auto foretold = Foretell(displacements, place);
    for (int axis = 0; axis < 3; ++axis) {
      const std::int64_t sum = foretold[axis] + (*remainders)[axis * rest_.cols() + place];
      const auto displacement = static_cast<std::int32_t>(sum);
      displacements[3 * place + axis] = displacement;
      positions(axis, neighbours_.order[place]) =
          static_cast<float>(static_cast<double>(rest_(axis, place)) + step * displacement);
    }
  }
  return positions;
}

}  // namespace phrenic::stream
