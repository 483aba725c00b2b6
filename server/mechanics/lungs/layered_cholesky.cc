#include "server/mechanics/lungs/layered_cholesky.h"

#include <utility>

namespace phrenic {
namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;

// Returns a block as a dense matrix.
Eigen::MatrixXd DenseBlock(const SparseMatrix& lower, int first, int rows, int column, int columns) {
  Eigen::MatrixXd block = Eigen::MatrixXd::Zero(rows, columns);
  for (int c = 0; c < columns; ++c) {
    for (SparseMatrix::InnerIterator entry(lower, column + c); entry; ++entry) {
      const auto row = entry.row() - first;
      if (row >= 0 && row < rows) block(row, c) = entry.value();
    }
  }
  return block;
}

bool CouplesNeighboursOnly(const SparseMatrix& lower, const std::vector<int>& starts) {
  for (size_t layer = 0; layer + 2 < starts.size(); ++layer) {
    for (int column = starts[layer]; column < starts[layer + 1]; ++column) {
      for (SparseMatrix::InnerIterator entry(lower, column); entry; ++entry) {
        if (entry.row() >= starts[layer + 2]) return false;
      }
    }
  }
  return true;
}

}  // namespace

std::optional<LayeredCholesky> LayeredCholesky::Make(const SparseMatrix& lower, const std::vector<int>& starts,
                                                     const StopCheck& stop) {
  if (!CouplesNeighboursOnly(lower, starts)) return std::nullopt;
  LayeredCholesky factors;
  factors.starts_ = starts;
  const size_t layers = starts.size() - 1;
  for (size_t l = 0; l < layers; ++l) {
    const int size = starts[l + 1] - starts[l];
    Eigen::MatrixXd block = DenseBlock(lower, starts[l], size, starts[l], size);
    if (l > 0) block.selfadjointView<Eigen::Lower>().rankUpdate(factors.below_.back(), -1);
    factors.diagonal_.emplace_back(std::move(block));
    if (factors.diagonal_.back().info() != Eigen::Success || stop.Stopped()) return std::nullopt;
    if (l + 1 == layers) break;
    Eigen::MatrixXd below = DenseBlock(lower, starts[l + 1], starts[l + 2] - starts[l + 1], starts[l], size);
    factors.diagonal_.back().matrixU().solveInPlace<Eigen::OnTheRight>(below);
    factors.below_.push_back(std::move(below));
  }
  return factors;
}

Eigen::MatrixXd LayeredCholesky::Solve(const Eigen::MatrixXd& b) const {
  Eigen::MatrixXd x = b;
  const auto layer = [&](size_t l) { return x.middleRows(starts_[l], starts_[l + 1] - starts_[l]); };
  const size_t layers = diagonal_.size();
  for (size_t l = 0; l < layers; ++l) {
    if (l > 0) layer(l) -= below_[l - 1] * layer(l - 1);
    auto rows = layer(l);
    diagonal_[l].matrixL().solveInPlace(rows);
  }
  for (size_t l = layers; l-- > 0;) {
    if (l + 1 < layers) layer(l) -= below_[l].transpose() * layer(l + 1);
    auto rows = layer(l);
    diagonal_[l].matrixU().solveInPlace(rows);
  }
  return x;
}

}  // namespace phrenic
