#include "server/stream/decoder/plain_decoders.h"

#include <bit>
#include <cstring>

#include "server/stream/decoder/grid_step.h"
#include "server/stream/decoder/read_number.h"

namespace phrenic::stream {
namespace {

constexpr std::size_t kPlanesHead = sizeof(double) + 3 * sizeof(float);

}  // namespace

bool AreFinite(std::span<const float> numbers) {
  constexpr std::uint32_t kExponent = 0x7f800000;
  std::uint32_t bad = 0;
  for (const float number : numbers) bad |= (std::bit_cast<std::uint32_t>(number) & kExponent) == kExponent ? 1 : 0;
  return bad == 0;
}

const char* DecodeRaw(std::string_view bytes, std::span<float> to) {
  if (bytes.size() != sizeof(float) * to.size()) return "positions: the bytes are of another number of vertices";
  if (!bytes.empty()) std::memcpy(to.data(), bytes.data(), bytes.size());
  return AreFinite(to) ? nullptr : "positions: a number is not finite";
}

const char* DecodePlanes(std::string_view bytes, ZstdDecoder& zstd, std::vector<std::uint8_t>& planes,
                         std::span<float> to) {
  if (bytes.size() < kPlanesHead) return "planes: the head is cut off";
  const double step = Read<double>(bytes, 0);
  if (!IsGridStep(step)) return "planes: the step is not within 0 to 1 m";
  const std::size_t count = to.size(), vertices = count / 3;
  planes.resize(2 * count);
  if (const char* problem = zstd.Decompress(bytes.substr(kPlanesHead), planes)) return problem;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double corner = Read<float>(bytes, sizeof(double) + sizeof(float) * axis);
    const std::uint8_t* const low = planes.data() + axis * vertices;
    const std::uint8_t* const high = low + count;
    for (std::size_t i = 0; i < vertices; ++i) {
      to[3 * i + axis] = static_cast<float>(corner + step * (low[i] + 256 * high[i]));
    }
  }
  return AreFinite(to) ? nullptr : "planes: a number is not finite";
}

}  // namespace phrenic::stream
