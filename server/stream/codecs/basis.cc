#include "server/stream/codecs/basis.h"

#include <algorithm>
#include <optional>

#include "server/stream/codecs/decode.h"
#include "server/stream/codecs/quantise.h"
#include "server/stream/codecs/wire.h"

namespace phrenic::stream {
namespace {

constexpr double kRidge = 1e-9;  // of the shapes' mean square: shapes may be equal on selected bodies

// What follows the coefficients.
enum class Rest : std::uint32_t { kNothing = 0, kAsItIs = 1, kPredicted = 2 };

// Returns the steps from `sum` to `positions`, three per place, 0 for vertices within `max_error`. Empty if all are;
// nothing if one exceeds the range.
std::optional<Steps> StepsFrom(const Eigen::Matrix3Xd& sum, const Floats& positions, double max_error, double step,
                               const std::vector<int>& order) {
  Steps steps;
  for (std::size_t place = 0; place < order.size(); ++place) {
    const Eigen::Vector3d own = positions.col(order[place]).cast<double>();
    const Eigen::Vector3f alone = sum.col(order[place]).cast<float>();
    if ((alone.cast<double>() - own).squaredNorm() <= max_error * max_error) continue;
    if (steps.empty()) steps.resize(3 * order.size());
    for (int axis = 0; axis < 3; ++axis) {
      const double moved = std::floor((own[axis] - sum(axis, order[place])) / step + 0.5);
      if (!(std::abs(moved) <= kFurthest)) return std::nullopt;
      steps[3 * place + axis] = static_cast<std::int32_t>(moved);
    }
  }
  return steps;
}

std::ptrdiff_t Zeros(const Steps& steps) { return std::count(steps.begin(), steps.end(), 0); }

}  // namespace

BasisCodec::BasisCodec(const RestShape& shape) : shape_(shape), predictor_(shape) {
  const auto count = static_cast<Eigen::Index>(shape.shapes.size());
  Eigen::MatrixXd gram(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      gram(i, j) = gram(j, i) = shape.shapes[i].cast<double>().cwiseProduct(shape.shapes[j].cast<double>()).sum();
    }
  }
  if (count == 0) return;
  gram.diagonal().array() += kRidge * (gram.trace() / static_cast<double>(count) + 1e-30);
  gram_.compute(gram);
}

BasisCodec::Parts BasisCodec::FindCoefficients(const Floats& positions) const {
  const auto count = static_cast<Eigen::Index>(shape_.shapes.size());
  const Floats moved = positions - shape_.rest;
  Eigen::VectorXd along(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    along[k] = shape_.shapes[k].cast<double>().cwiseProduct(moved.cast<double>()).sum();
  }
  Parts parts(shape_.shapes.size(), 0);
  if (count == 0) return parts;
  const Eigen::VectorXf found = gram_.solve(along).cast<float>();
  if (found.allFinite()) std::copy(found.begin(), found.end(), parts.begin());
  return parts;
}

BasisCodec::Doubles BasisCodec::Sum(const Parts& parts) const {
  Doubles sum = shape_.rest.cast<double>();
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const double part = parts[k];
    const float* const shape = shape_.shapes[k].data();
    double* const to = sum.data();
    for (Eigen::Index i = 0; i < sum.size(); ++i) to[i] += part * static_cast<double>(shape[i]);
  }
  return sum;
}

absl::StatusOr<std::string> BasisCodec::Encode(const Floats& positions, double max_error) const {
  const auto step = GridStep(positions, max_error);
  if (!step.has_value() || !IsGridStep(*step)) return absl::OutOfRangeError(kTooFine);
  const Parts parts = FindCoefficients(positions);
  const auto steps = StepsFrom(Sum(parts), positions, max_error, *step, predictor_.order());
  if (!steps.has_value()) return absl::OutOfRangeError(kTooFar);
  const Steps residuals = predictor_.Residuals(*steps);
  const bool fewer = Zeros(residuals) > Zeros(*steps);
  const Rest rest = steps->empty() ? Rest::kNothing : fewer ? Rest::kPredicted : Rest::kAsItIs;
  std::string bytes;
  Append(*step, bytes);
  Append(static_cast<std::uint32_t>(parts.size()), bytes);
  Append(static_cast<std::uint32_t>(rest), bytes);
  for (const float part : parts) Append(part, bytes);
  if (rest != Rest::kNothing) AppendResiduals(fewer ? residuals : *steps, bytes);
  return bytes;
}

absl::StatusOr<Floats> BasisCodec::Decode(std::string_view bytes) const {
  PositionDecoder decoder(MeshOf(shape_).rest, predictor_.weights());
  decoder.SetBasis(JoinShapes(shape_.shapes), shape_.shapes.size());
  return DecodeBy(decoder, v1::CODEC_BASIS, bytes);
}

}  // namespace phrenic::stream
