#include "server/mechanics/lungs/layered_cholesky.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

namespace phrenic {
namespace {

// Positive definite, dense within layers of 3, 1, 4 and 2 unknowns and between neighbours.
Eigen::MatrixXd LayeredMatrix(const std::vector<int>& starts) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> value(-1, 1);
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(starts.back(), starts.back());
  for (size_t l = 0; l + 1 < starts.size(); ++l) {
    const int end = starts[std::min(l + 2, starts.size() - 1)];
    const Eigen::MatrixXd part = Eigen::MatrixXd::NullaryExpr(end - starts[l], 20, [&] { return value(random); });
    a.block(starts[l], starts[l], end - starts[l], end - starts[l]) += part * part.transpose();
  }
  return a;
}

TEST(LayeredCholesky, SolvesAsADenseSolverDoes) {
  const std::vector<int> starts = {0, 3, 4, 8, 10};
  const Eigen::MatrixXd a = LayeredMatrix(starts), b = Eigen::MatrixXd::Random(10, 3);
  const Eigen::SparseMatrix<double> lower = a.triangularView<Eigen::Lower>().toDenseMatrix().sparseView();
  const auto factors = LayeredCholesky::Make(lower, starts, {});
  ASSERT_TRUE(factors.has_value());
  EXPECT_LT((a * factors->Solve(b) - b).norm(), 1e-10);
}

TEST(LayeredCholesky, RejectsWhatItCannotFactorise) {
  const std::vector<int> starts = {0, 3, 4, 8, 10};
  Eigen::MatrixXd a = LayeredMatrix(starts).triangularView<Eigen::Lower>();
  EXPECT_FALSE(LayeredCholesky::Make((-a).sparseView(), starts, {}).has_value());
  a(9, 0) = 1;  // couples the first layer and the last
  EXPECT_FALSE(LayeredCholesky::Make(a.sparseView(), starts, {}).has_value());
}

}  // namespace
}  // namespace phrenic
