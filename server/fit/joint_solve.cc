#include "server/fit/joint_solve.h"

#include <Eigen/Cholesky>

namespace phrenic::fit {
namespace {

constexpr int kMostSteps = 100, kMostMatches = 25;
constexpr double kSmallStep = 1e-5;  // of the numbers' prior standard deviations

// The objective and its quadratic model at a point.
struct Quadratic {
  double value = 0;
  Eigen::VectorXd descent;  // minus the gradient
  Eigen::MatrixXd curvature;
};

class JointProblem {
 public:
  JointProblem(const FitSpace& space, const AllResiduals& all)
      : space_(space), all_(all), mean_(space.Mean()), precision_(space.Precision()) {}

  Quadratic At(const Eigen::VectorXd& numbers) const {
    const Eigen::VectorXd off = mean_ - numbers;
    Quadratic at = {0.5 * off.dot(precision_ * off), precision_ * off, precision_};
    for (const auto& residuals : all_) {
      const Rows rows = residuals->At(numbers, Part::kFitting);
      if (rows.residual.size() == 0) continue;
      const Eigen::MatrixXd weighted = rows.weight.asDiagonal() * rows.slope;
      at.value += 0.5 * rows.residual.dot(rows.weight.cwiseProduct(rows.residual));
      at.descent += weighted.transpose() * rows.residual;
      at.curvature += weighted.transpose() * rows.slope;
    }
    return at;
  }

  // Returns the damped step, 0 for numbers that are held at their bounds.
  Eigen::VectorXd Step(const Eigen::VectorXd& numbers, const Quadratic& at, double damping) const {
    Eigen::MatrixXd matrix = at.curvature;
    matrix.diagonal() *= 1 + damping;
    Eigen::VectorXd right = at.descent;
    for (Eigen::Index k = 0; k < numbers.size(); ++k) {
      const FitNumber& number = space_.numbers()[static_cast<size_t>(k)];
      const bool held = (numbers[k] <= number.low && right[k] < 0) || (numbers[k] >= number.high && right[k] > 0);
      if (!held) continue;
      matrix.row(k).setZero();
      matrix.col(k).setZero();
      matrix(k, k) = 1;
      right[k] = 0;
    }
    return matrix.ldlt().solve(right);
  }

 private:
  const FitSpace& space_;
  const AllResiduals& all_;
  const Eigen::VectorXd mean_;
  const Eigen::MatrixXd precision_;
};

// Minimises with the present matches. Returns false if it was stopped.
bool Minimise(const FitSpace& space, const JointProblem& problem, const std::function<bool()>& stop,
              const Eigen::VectorXd& sizes, Eigen::VectorXd& numbers) {
  Quadratic at = problem.At(numbers);
  double damping = 1e-6;
  for (int step = 0; step < kMostSteps; ++step) {
    if (stop && stop()) return false;
    const Eigen::VectorXd to = space.Bounded(numbers + problem.Step(numbers, at, damping));
    if ((to - numbers).cwiseQuotient(sizes).cwiseAbs().maxCoeff() < kSmallStep) return true;
    Quadratic next = problem.At(to);
    if (!(next.value <= at.value)) {
      damping *= 10;
      continue;
    }
    numbers = to;
    at = std::move(next);
    damping = std::max(damping / 10, 1e-12);
  }
  return true;
}

}  // namespace

absl::StatusOr<JointSolution> SolveJointly(const FitSpace& space, const AllResiduals& all,
                                           const std::function<bool()>& stop) {
  const JointProblem problem(space, all);
  const Eigen::VectorXd sizes = space.Covariance().diagonal().cwiseSqrt();
  Eigen::VectorXd numbers = space.Bounded(space.Mean());
  for (int match = 0; match < kMostMatches; ++match) {
    const Eigen::VectorXd before = numbers;
    for (const auto& residuals : all) residuals->Match(numbers);
    if (!Minimise(space, problem, stop, sizes, numbers)) return absl::CancelledError("interrupted");
    if ((numbers - before).cwiseQuotient(sizes).cwiseAbs().maxCoeff() < 10 * kSmallStep) break;
  }
  const Eigen::MatrixXd curvature = problem.At(numbers).curvature;
  JointSolution solution = {numbers, curvature.ldlt().solve(Eigen::MatrixXd::Identity(numbers.size(), numbers.size()))};
  return solution;
}

}  // namespace phrenic::fit
