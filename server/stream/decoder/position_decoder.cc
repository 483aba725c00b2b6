#include "server/stream/decoder/position_decoder.h"

#include <algorithm>
#include <utility>

#include "server/stream/decoder/grid_step.h"
#include "server/stream/decoder/plain_decoders.h"
#include "server/stream/decoder/read_number.h"

namespace phrenic::stream {
namespace {

constexpr std::size_t kBasisHead = 16;  // step float64, number of shapes, kind of residuals

// Numbers of phrenic.v1.Codec, whose header the decoder does not include; codecs/codecs.cc asserts that they are equal.
enum CodecNumber : int { kUnspecified = 0, kRaw = 1, kPlanes = 2, kPredicted = 3, kBasis = 4 };

// What follows the coefficients of CODEC_BASIS.
enum class BasisRest : std::uint32_t { kNothing = 0, kSteps = 1, kResiduals = 2 };

std::vector<float> PaddedInOrder(std::span<const float> rest, const std::vector<int>& order) {
  std::vector<float> ordered(4 * order.size());
  for (std::size_t place = 0; place < order.size(); ++place) {
    std::copy_n(rest.begin() + 3 * static_cast<std::ptrdiff_t>(order[place]), 3,
                ordered.begin() + 4 * static_cast<std::ptrdiff_t>(place));
  }
  return ordered;
}

}  // namespace

PositionDecoder::PositionDecoder(const RestMesh& mesh) : PositionDecoder(mesh.rest, MakeNeighbourWeights(mesh)) {}

PositionDecoder::PositionDecoder(std::span<const float> rest, const NeighbourWeights& weights)
    : rest_(rest.begin(), rest.end()),
      order_(weights.order),
      prediction_(weights),
      ordered_rest_(PaddedInOrder(rest, order_)) {}

void PositionDecoder::SetBasis(std::vector<float> shapes, std::size_t count) {
  shapes_ = std::move(shapes);
  shape_count_ = count;
}

const char* PositionDecoder::Decode(int codec, std::string_view bytes, std::span<float> to) {
  switch (codec) {
    case kUnspecified:
    case kRaw:
      return DecodeRaw(bytes, to);
    case kPlanes:
      return DecodePlanes(bytes, to);
    case kPredicted:
      return DecodePredicted(bytes, to);
    case kBasis:
      return DecodeBasis(bytes, to);
    default:
      return "codec: this version does not know it";
  }
}

const char* PositionDecoder::DecodePlanes(std::string_view bytes, std::span<float> to) {
  return stream::DecodePlanes(bytes, zstd_, planes_, to);
}

const char* PositionDecoder::ReadSteps(std::string_view bytes) {
  const char* const problem = residuals_.Read(bytes, order_.size(), zstd_);
  return problem != nullptr ? problem : residuals_.Unpack(steps_);
}

const char* PositionDecoder::ReadPredicted(std::string_view bytes) {
  if (const char* problem = ReadSteps(bytes)) return problem;
  if (prediction_.AddFast(steps_)) return nullptr;
  residuals_.Unpack(steps_);
  prediction_.AddExactly(steps_);
  return nullptr;
}

const char* PositionDecoder::DecodePredicted(std::string_view bytes, std::span<float> to) {
  if (bytes.size() < sizeof(double)) return "predicted: the head is cut off";
  const double step = Read<double>(bytes, 0);
  if (!IsGridStep(step)) return "predicted: the step is not within 0 to 1 m";
  if (const char* problem = ReadPredicted(bytes.substr(sizeof step))) return problem;
  const float* rest = ordered_rest_.data();
  const std::int32_t* moved = steps_.data();
  for (const int vertex : order_) {
    float* const own = to.data() + 3 * static_cast<std::size_t>(vertex);
    for (int axis = 0; axis < 3; ++axis)
      own[axis] = static_cast<float>(static_cast<double>(rest[axis]) + step * moved[axis]);
    rest += 4, moved += 4;
  }
  return nullptr;
}

void PositionDecoder::AddShapes(std::string_view coefficients) {
  sum_.assign(rest_.begin(), rest_.end());
  const float* shape = shapes_.data();
  for (std::size_t at = 0; at < coefficients.size(); at += sizeof(float), shape += sum_.size()) {
    const double part = Read<float>(coefficients, at);
    for (std::size_t i = 0; i < sum_.size(); ++i) sum_[i] += part * static_cast<double>(shape[i]);
  }
}

const char* PositionDecoder::DecodeBasis(std::string_view bytes, std::span<float> to) {
  const std::size_t head = kBasisHead + sizeof(float) * shape_count_;
  if (bytes.size() < head) return "basis: the head is cut off";
  const double step = Read<double>(bytes, 0);
  if (!IsGridStep(step)) return "basis: the step is not within 0 to 1 m";
  if (Read<std::uint32_t>(bytes, 8) != shape_count_) return "basis: it is of another number of shapes";
  const auto rest = static_cast<BasisRest>(Read<std::uint32_t>(bytes, 12));
  if (rest > BasisRest::kResiduals) return "basis: it has an unknown kind of residuals";
  if (rest == BasisRest::kNothing && bytes.size() != head) return "basis: more follows than was said";
  AddShapes(bytes.substr(kBasisHead, head - kBasisHead));
  if (rest != BasisRest::kNothing) {
    const std::string_view after = bytes.substr(head);
    const char* const problem = rest == BasisRest::kResiduals ? ReadPredicted(after) : ReadSteps(after);
    if (problem != nullptr) return problem;
    const std::int32_t* moved = steps_.data();
    for (const int vertex : order_) {
      for (std::size_t axis = 0; axis < 3; ++axis)
        sum_[3 * static_cast<std::size_t>(vertex) + axis] += step * moved[axis];
      moved += 4;
    }
  }
  std::transform(sum_.begin(), sum_.end(), to.begin(), [](double number) { return static_cast<float>(number); });
  return AreFinite(to) ? nullptr : "basis: a number is not finite";
}

}  // namespace phrenic::stream
