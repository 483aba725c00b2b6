#include "server/fit/least_squares.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <random>

namespace phrenic::fit {
namespace {

// The normal equations of some of the points.
struct Normal {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd right;
  double points = 0;

  void Add(const Normal& other) {
    matrix += other.matrix;
    right += other.right;
    points += other.points;
  }
};

Normal Zero(Eigen::Index size) { return {Eigen::MatrixXd::Zero(size, size), Eigen::VectorXd::Zero(size), 0}; }

// Returns c_k^2 of LeastSquares.
Eigen::VectorXd ColumnScales(const Eigen::MatrixXd& a) {
  return a.colwise().squaredNorm().transpose() * 3 / static_cast<double>(a.rows());
}

Eigen::VectorXd Solve(const Normal& normal, const Eigen::VectorXd& scales, double ridge) {
  Eigen::MatrixXd matrix = normal.matrix;
  matrix.diagonal() += ridge * normal.points * (scales.array() + 1e-18).matrix();
  return matrix.ldlt().solve(normal.right);
}

// Returns the normal equations of each block of points that has any.
std::vector<Normal> BlocksOf(const Eigen::MatrixXd& a, const Eigen::VectorXd& u, const Points& points, double block) {
  std::map<std::array<int, 3>, Normal> blocks;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3i cell = (points.col(i) / block).array().floor().cast<int>();
    const auto rows = a.middleRows<3>(3 * i);
    Normal& normal = blocks.try_emplace({cell.x(), cell.y(), cell.z()}, Zero(a.cols())).first->second;
    normal.Add({rows.transpose() * rows, rows.transpose() * u.segment<3>(3 * i), 1});
  }
  std::vector<Normal> result;
  result.reserve(blocks.size());
  for (auto& [cell, normal] : blocks) result.push_back(std::move(normal));
  return result;
}

// Returns a number in 0..below-1. Independent of the standard library's distributions.
size_t Draw(std::mt19937_64& random, size_t below) { return static_cast<size_t>(random() % below); }

// Sets standard errors and correlations from samples, one column each.
void Spread(const Eigen::MatrixXd& samples, Estimate& estimate) {
  const Eigen::MatrixXd centred = samples.colwise() - samples.rowwise().mean();
  const Eigen::MatrixXd covariance = centred * centred.transpose() / static_cast<double>(samples.cols() - 1);
  estimate.standard_error = covariance.diagonal().cwiseSqrt();
  const Eigen::VectorXd inverse =
      (estimate.standard_error.array() > 0).select(estimate.standard_error.cwiseInverse(), 0);
  estimate.correlation = inverse.asDiagonal() * covariance * inverse.asDiagonal();
}

}  // namespace

Eigen::VectorXd LeastSquares(const Eigen::MatrixXd& a, const Eigen::VectorXd& u, double ridge) {
  return Solve({a.transpose() * a, a.transpose() * u, static_cast<double>(a.rows()) / 3}, ColumnScales(a), ridge);
}

Estimate BootstrapLeastSquares(const Eigen::MatrixXd& a, const Eigen::VectorXd& u, double ridge, const Points& points,
                               std::uint64_t seed, double block, int samples) {
  Estimate estimate = {LeastSquares(a, u, ridge), {}, {}};
  const std::vector<Normal> blocks = BlocksOf(a, u, points, block);
  const Eigen::VectorXd scales = ColumnScales(a);
  std::mt19937_64 random(seed);
  Eigen::MatrixXd values(a.cols(), samples);
  for (int s = 0; s < samples; ++s) {
    Normal drawn = Zero(a.cols());
    for (size_t b = 0; b < blocks.size(); ++b) drawn.Add(blocks[Draw(random, blocks.size())]);
    values.col(s) = Solve(drawn, scales, ridge);
  }
  Spread(values, estimate);
  return estimate;
}

Halves SplitInHalves(int count, std::uint64_t seed) {
  std::vector<int> order(static_cast<size_t>(count));
  std::iota(order.begin(), order.end(), 0);
  std::mt19937_64 random(seed);
  for (size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[Draw(random, i)]);
  Halves halves;
  halves.fitting.assign(order.begin(), order.begin() + count / 2);
  halves.held_out.assign(order.begin() + count / 2, order.end());
  std::sort(halves.fitting.begin(), halves.fitting.end());
  std::sort(halves.held_out.begin(), halves.held_out.end());
  return halves;
}

}  // namespace phrenic::fit
