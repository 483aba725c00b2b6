#include "server/stream/codecs/planes.h"

#include <cstring>

#include "server/stream/codecs/quantise.h"
#include "server/stream/codecs/wire.h"
#include "server/stream/codecs/zstd.h"

namespace phrenic::stream {
namespace {

constexpr double kMost = 65535;

struct Head {
  double step = 0;  // [m]
  float corner[3] = {0, 0, 0};
};
constexpr std::size_t kPlanesHead = sizeof(double) + 3 * sizeof(float);

}  // namespace

absl::StatusOr<std::string> PlanesCodec::Encode(const Floats& positions, double max_error) const {
  const auto step = GridStep(positions, max_error);
  if (!step.has_value()) return absl::OutOfRangeError("the bound is finer than float32");
  Eigen::Vector3f corner = Eigen::Vector3f::Zero();
  if (positions.cols() > 0) corner = positions.rowwise().minCoeff();
  const std::ptrdiff_t count = positions.size();
  std::string planes(2 * static_cast<std::size_t>(count), '\0');
  std::ptrdiff_t place = 0;
  for (int axis = 0; axis < 3; ++axis) {
    for (Eigen::Index i = 0; i < positions.cols(); ++i, ++place) {
      const double q = std::floor((static_cast<double>(positions(axis, i)) - corner[axis]) / *step + 0.5);
      if (q > kMost) return absl::OutOfRangeError("the positions lie more than 65,535 steps apart");
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
  if (bytes.size() < kPlanesHead) return absl::InvalidArgumentError("planes: the head is cut off");
  const Head head = {.step = Read<double>(bytes, 0),
                     .corner = {Read<float>(bytes, 8), Read<float>(bytes, 12), Read<float>(bytes, 16)}};
  if (!IsGridStep(head.step)) return absl::InvalidArgumentError("planes: the step is not within 0 to 1 m");
  Floats positions(3, vertices_);
  const std::ptrdiff_t count = positions.size();
  const auto planes = Decompress(bytes.substr(kPlanesHead), 2 * static_cast<std::size_t>(count));
  if (!planes.ok()) return planes.status();
  std::ptrdiff_t place = 0;
  for (int axis = 0; axis < 3; ++axis) {
    for (Eigen::Index i = 0; i < vertices_; ++i, ++place) {
      const unsigned low = static_cast<unsigned char>((*planes)[place]);
      const unsigned high = static_cast<unsigned char>((*planes)[place + count]);
      positions(axis, i) = static_cast<float>(head.corner[axis] + head.step * (low + 256 * high));
    }
  }
  if (!positions.allFinite()) return absl::InvalidArgumentError("planes: a number is not finite");
  return positions;
}

}  // namespace phrenic::stream
