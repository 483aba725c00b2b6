#include "server/stream/basis.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace phrenic::stream {
namespace {

// Error bound of an encoded shape [m]. Frames are combined from decoded shapes, so it does not add to their error.
constexpr double kBound = 1e-5;
constexpr double kSmallest = 1e-6;  // root mean square of a shape over the displacements [m]

Eigen::MatrixXd GramOf(const std::vector<Floats>& displacements) {
  const auto count = static_cast<Eigen::Index>(displacements.size());
  Eigen::MatrixXd gram(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Matrix3Xd one = displacements[i].cast<double>();
    for (Eigen::Index j = 0; j <= i; ++j) {
      gram(i, j) = gram(j, i) = one.cwiseProduct(displacements[j].cast<double>()).sum();
    }
  }
  return gram;
}

}  // namespace

std::vector<Floats> FindShapes(const std::vector<Floats>& displacements) {
  std::vector<Floats> shapes;
  if (displacements.empty() || displacements.front().cols() == 0) return shapes;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(GramOf(displacements));
  const auto count = static_cast<Eigen::Index>(displacements.size());
  const double numbers = static_cast<double>(displacements.front().size()) * static_cast<double>(count);
  for (Eigen::Index k = count - 1; k >= 0 && static_cast<int>(shapes.size()) < kMostShapes; --k) {
    const double variance = solver.eigenvalues()[k];
    if (!(variance > kSmallest * kSmallest * numbers)) break;
    // u = A v / s has the coefficient s v_j in displacement j, so A v max_j |v_j| has its largest amplitude.
    const Eigen::VectorXd v = solver.eigenvectors().col(k);
    const double largest = v.cwiseAbs().maxCoeff();
    Floats& shape = shapes.emplace_back(Floats::Zero(3, displacements.front().cols()));
    for (Eigen::Index j = 0; j < count; ++j) shape += static_cast<float>(largest * v[j]) * displacements[j];
  }
  return shapes;
}

absl::StatusOr<Basis> MakeBasis(const Codec& predicted, const Floats& rest, const std::vector<Floats>& shapes,
                                std::int64_t epoch) {
  Basis basis{.epoch = epoch, .encoded = {}, .shapes = {}};
  for (const Floats& shape : shapes) {
    auto bytes = predicted.Encode(rest + shape, kBound);
    if (!bytes.ok()) return bytes.status();
    const auto decoded = predicted.Decode(*bytes);
    if (!decoded.ok()) return decoded.status();
    basis.encoded.push_back(*std::move(bytes));
    basis.shapes.emplace_back(*decoded - rest);
  }
  return basis;
}

}  // namespace phrenic::stream
