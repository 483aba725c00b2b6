#include "server/stream/codecs/planes.h"

#include "server/stream/codecs/quantise.h"
#include "server/stream/codecs/wire.h"
#include "server/stream/codecs/zstd.h"
#include "server/stream/decoder/plain_decoders.h"

namespace phrenic::stream {
namespace {

constexpr double kMost = 65535;

}  // namespace

absl::StatusOr<std::string> PlanesCodec::Encode(const Floats& positions, double max_error) const {
  const auto step = GridStep(positions, max_error);
  if (!step.has_value()) return absl::OutOfRangeError(kTooFine);
  Eigen::Vector3f corner = Eigen::Vector3f::Zero();
  if (positions.cols() > 0) corner = positions.rowwise().minCoeff();
  const std::ptrdiff_t count = positions.size();
  std::string planes(2 * static_cast<std::size_t>(count), '\0');
  std::ptrdiff_t place = 0;
  for (int axis = 0; axis < 3; ++axis) {
    for (Eigen::Index i = 0; i < positions.cols(); ++i, ++place) {
      const double q = std::floor((static_cast<double>(positions(axis, i)) - corner[axis]) / *step + 0.5);
      if (q > kMost) return absl::OutOfRangeError(kTooFar);
      const auto value = static_cast<unsigned>(q);
      planes[place] = static_cast<char>(value & 0xff);
      planes[place + count] = static_cast<char>(value >> 8);
    }
  }
  std::string bytes;
  Append(*step, bytes);
  for (const float coordinate : corner) Append(coordinate, bytes);
  AppendCompressed(planes, bytes);
  return bytes;
}

absl::StatusOr<Floats> PlanesCodec::Decode(std::string_view bytes) const {
  Floats positions(3, vertices_);
  const auto zstd = std::make_unique<ZstdDecoder>();
  std::vector<std::uint8_t> planes;
  const std::span<float> to(positions.data(), static_cast<std::size_t>(positions.size()));
  if (const char* problem = DecodePlanes(bytes, *zstd, planes, to)) return absl::InvalidArgumentError(problem);
  return positions;
}

}  // namespace phrenic::stream
