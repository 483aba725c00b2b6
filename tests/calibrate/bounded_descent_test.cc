// The search within bounds: it ends at the exact minimum of linear models, and says when it could not.
#include "server/calibrate/bounded_descent.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <random>

namespace phrenic::calibrate {
namespace {

// Residuals of a linear model: the sum of w (data - slopes x)^2 and |x|^2.
class LinearSquares : public SquaresProblem {
 public:
  LinearSquares(Eigen::MatrixXd slopes, Eigen::VectorXd data, Eigen::VectorXd weights)
      : slopes_(std::move(slopes)), data_(std::move(data)), weights_(std::move(weights)) {}

  absl::StatusOr<double> Try(const Eigen::VectorXd& x) override {
    tried_ = x;
    if (diverges) return absl::FailedPreconditionError("the breath diverges");
    return Sum(x);
  }
  void Accept() override { at_ = tried_; }
  absl::StatusOr<Quadratic> Expand() override {
    return Quadratic{Curvature(), slopes_.transpose() * weights_.cwiseProduct(data_ - slopes_ * at_) - at_};
  }

  void Begin(const Eigen::VectorXd& x) { at_ = x; }
  double Sum(const Eigen::VectorXd& x) const {
    return weights_.dot((data_ - slopes_ * x).cwiseAbs2()) + x.squaredNorm();
  }
  Eigen::MatrixXd Curvature() const {
    return slopes_.transpose() * weights_.asDiagonal() * slopes_ +
           Eigen::MatrixXd::Identity(slopes_.cols(), slopes_.cols());
  }

  // Returns the least of the minima over each choice of numbers at their low bound, at their high one and free.
  Eigen::VectorXd Exact(const Eigen::VectorXd& low, const Eigen::VectorXd& high) const {
    const Eigen::Index n = low.size();
    Eigen::VectorXd best;
    for (int choice = 0; choice < std::pow(3, n); ++choice) {
      Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
      std::vector<Eigen::Index> free;
      for (Eigen::Index k = 0, rest = choice; k < n; ++k, rest /= 3) {
        if (rest % 3 == 2) free.push_back(k);
        if (rest % 3 != 2) x[k] = rest % 3 == 0 ? low[k] : high[k];
      }
      const Eigen::VectorXd descent = slopes_.transpose() * weights_.cwiseProduct(data_ - slopes_ * x) - x;
      const Eigen::MatrixXd curvature = Curvature();
      const Eigen::MatrixXd part = curvature(free, free);
      const Eigen::VectorXd there = part.ldlt().solve(descent(free).eval());
      x(free) = there;
      const bool inside = (x.array() >= low.array()).all() && (x.array() <= high.array()).all();
      if (inside && (best.size() == 0 || Sum(x) < Sum(best))) best = x;
    }
    return best;
  }

  bool diverges = false;

 private:
  Eigen::MatrixXd slopes_;
  Eigen::VectorXd data_, weights_, at_, tried_;
};

// Searches from zero, or the nearest point within the bounds.
Settling SearchLinear(LinearSquares& problem, const Eigen::VectorXd& low, const Eigen::VectorXd& high,
                      Eigen::VectorXd& found) {
  const Eigen::VectorXd begin = Eigen::VectorXd::Zero(low.size()).cwiseMax(low).cwiseMin(high);
  problem.Begin(begin);
  BoundedDescent search(problem, begin, problem.Sum(begin), low, high);
  Settling settling = Settling::kGoesOn;
  for (int i = 0; i < 60 && settling == Settling::kGoesOn; ++i) settling = *search.Step();
  found = search.x();
  return settling;
}

// p1 + p2 = 2 and p1 - p2 = 2, each known by its weight, with priors of 0 +- 3 and p1 <= 1: at this bound, p2 is where
// the derivative by it alone is zero.
TEST(BoundedDescent, GoesOnAlongABound) {
  for (const double first : {10.0, 1.0, 0.1, 300.0}) {
    for (const double second : {1.0, 10.0, 0.1}) {
      const Eigen::MatrixXd slopes = 3 * (Eigen::MatrixXd(2, 2) << 1, 1, 1, -1).finished();
      LinearSquares problem(slopes, Eigen::Vector2d(2, 2), Eigen::Vector2d(first, second));
      const Eigen::Vector2d low(-20, -20), high(1.0 / 3, 20);
      Eigen::VectorXd found;
      EXPECT_EQ(SearchLinear(problem, low, high, found), Settling::kSettled);
      EXPECT_EQ(found[0], high[0]);
      EXPECT_NEAR(3 * found[1], (first - second) / (first + second + 1.0 / 9), 1e-9) << first << " " << second;
    }
  }
}

TEST(BoundedDescent, EndsAtTheExactMinimumWithinBounds) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(-2, 2);
  int at_bounds = 0;
  for (int model = 0; model < 300; ++model) {
    const Eigen::Index n = 1 + model % 4;
    const auto drawn = [&] { return normal(random); };
    LinearSquares problem(Eigen::MatrixXd::NullaryExpr(n + 1, n, drawn), 3 * Eigen::VectorXd::NullaryExpr(n + 1, drawn),
                          Eigen::VectorXd::NullaryExpr(n + 1, [&] { return std::pow(10, uniform(random)); }));
    const Eigen::VectorXd one = Eigen::VectorXd::NullaryExpr(n, drawn), other = Eigen::VectorXd::NullaryExpr(n, drawn);
    const Eigen::VectorXd low = one.cwiseMin(other), high = one.cwiseMax(other);
    Eigen::VectorXd found;
    EXPECT_EQ(SearchLinear(problem, low, high, found), Settling::kSettled) << model;
    const Eigen::VectorXd exact = problem.Exact(low, high), off = found - exact;
    EXPECT_LT(std::sqrt(off.dot(problem.Curvature() * off)), 0.03) << model << ", in standard errors";
    const auto bound = (exact.array() == low.array()) || (exact.array() == high.array());
    at_bounds += bound.any() && !bound.all();
    // The first quadratic is the sum itself, so that one step ends there.
    problem.Begin(low);
    const Eigen::VectorXd step = StepWithin(*problem.Expand(), Eigen::VectorXd::Zero(n), high - low);
    EXPECT_LT((low + step - exact).cwiseAbs().maxCoeff(), 1e-8) << model;
  }
  EXPECT_GT(at_bounds, 80) << "models with numbers at a bound and others";
}

TEST(BoundedDescent, IsStuckNotSettledWhereEveryTrialFails) {
  LinearSquares problem(Eigen::MatrixXd::Identity(2, 2), Eigen::Vector2d(2, 1), Eigen::Vector2d(4, 4));
  problem.diverges = true;
  problem.Begin(Eigen::Vector2d::Zero());
  BoundedDescent search(problem, Eigen::Vector2d::Zero(), problem.Sum(Eigen::Vector2d::Zero()), Eigen::Vector2d(-3, -3),
                        Eigen::Vector2d(3, 3));
  EXPECT_EQ(*search.Step(), Settling::kStuck);
  EXPECT_EQ(search.x(), Eigen::VectorXd(Eigen::Vector2d::Zero()));
  EXPECT_EQ(search.without_sum(), 4);
  problem.diverges = false;
  EXPECT_EQ(*search.Step(), Settling::kGoesOn) << "it can go on from there";
}

}  // namespace
}  // namespace phrenic::calibrate
