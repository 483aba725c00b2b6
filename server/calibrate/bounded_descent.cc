#include "server/calibrate/bounded_descent.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace phrenic::calibrate {
namespace {

constexpr double kSmallStep = 0.03;   // that ends the search, in standard errors
constexpr int kMostTries = 4;         // of a step, each shorter
constexpr double kLargestStep = 1.5;  // in prior standard deviations

// The numbers that are held at a bound, and the step so far.
struct ActiveSet {
  const Quadratic& at;
  const Eigen::VectorXd &low, &high;
  Eigen::VectorXd step;
  std::vector<bool> held;

  Eigen::VectorXd Descent() const { return at.descent - at.curvature * step; }

  // Returns the change that minimises the quadratic, the held numbers left out.
  Eigen::VectorXd OfTheOthers() const {
    std::vector<Eigen::Index> others;
    for (Eigen::Index k = 0; k < step.size(); ++k) {
      if (!held[static_cast<size_t>(k)]) others.push_back(k);
    }
    const Eigen::VectorXd descent = Descent();
    const Eigen::MatrixXd curvature = at.curvature(others, others);
    Eigen::VectorXd change = Eigen::VectorXd::Zero(step.size());
    if (others.empty()) return change;
    const Eigen::VectorXd part = curvature.ldlt().solve(descent(others).eval());
    change(others) = part;
    return change;
  }

  // Goes along the change up to the first bound, and holds the number that meets it. Returns false if none does.
  bool GoToABound(const Eigen::VectorXd& change) {
    double part = 1;
    Eigen::Index first = -1;
    for (Eigen::Index k = 0; k < step.size(); ++k) {
      if (change[k] == 0) continue;
      const double room = ((change[k] > 0 ? high : low)[k] - step[k]) / change[k];
      if (room < part) part = std::max(0.0, room), first = k;
    }
    step += part * change;
    if (first < 0) return false;
    step[first] = (change[first] > 0 ? high : low)[first];
    held[static_cast<size_t>(first)] = true;
    return true;
  }

  // Lets go the held number whose descent points inwards most. Returns false if none does.
  bool LetGo() {
    const Eigen::VectorXd descent = Descent();
    double most = 0;
    Eigen::Index inwards = -1;
    for (Eigen::Index k = 0; k < step.size(); ++k) {
      if (!held[static_cast<size_t>(k)] || low[k] == high[k]) continue;
      const double along = (step[k] == high[k] ? -1 : 1) * descent[k] / std::sqrt(at.curvature(k, k));
      if (along > most) most = along, inwards = k;
    }
    if (inwards < 0) return false;
    held[static_cast<size_t>(inwards)] = false;
    return true;
  }
};

}  // namespace

Eigen::VectorXd StepWithin(const Quadratic& at, const Eigen::VectorXd& low, const Eigen::VectorXd& high) {
  const Eigen::Index n = at.descent.size();
  ActiveSet set{at, low, high, Eigen::VectorXd::Zero(n), std::vector<bool>(static_cast<size_t>(n))};
  // Each round lowers the quadratic or holds one more, so that it ends; the limit is against rounding.
  for (Eigen::Index round = 0; round < 20 * (n + 1); ++round) {
    if (!set.GoToABound(set.OfTheOthers()) && !set.LetGo()) break;
  }
  return set.step;
}

BoundedDescent::BoundedDescent(SquaresProblem& problem, Eigen::VectorXd x, double sum, Eigen::VectorXd low,
                               Eigen::VectorXd high)
    : problem_(problem), x_(std::move(x)), sum_(sum), low_(std::move(low)), high_(std::move(high)) {}

absl::Status BoundedDescent::Expand() {
  absl::StatusOr<Quadratic> there = problem_.Expand();
  if (!there.ok()) return there.status();
  at_ = *std::move(there);
  return absl::OkStatus();
}

Eigen::VectorXd BoundedDescent::Proposed(double damping) const {
  Quadratic damped = at_;
  damped.curvature.diagonal() *= 1 + damping;
  const Eigen::VectorXd step = StepWithin(damped, low_ - x_, high_ - x_);
  return step * std::min(1.0, kLargestStep / std::max(step.cwiseAbs().maxCoeff(), 1e-12));
}

absl::StatusOr<bool> BoundedDescent::Lowers(const Eigen::VectorXd& x) {
  const absl::StatusOr<double> sum = problem_.Try(x);
  if (!sum.ok() && !absl::IsFailedPrecondition(sum.status())) return sum.status();
  if (!sum.ok() || !std::isfinite(*sum)) ++without_sum_;
  if (!sum.ok() || !(*sum < sum_)) return false;
  problem_.Accept();
  x_ = x;
  sum_ = *sum;
  return true;
}

absl::StatusOr<Settling> BoundedDescent::Step() {
  if (absl::Status status = Expand(); !status.ok()) return status;
  const Eigen::VectorXd whole = Proposed(0);
  without_sum_ = 0;
  if (std::sqrt(whole.dot(at_.curvature * whole)) < kSmallStep) return Settling::kSettled;
  for (int tries = 0; tries < kMostTries; ++tries) {
    const absl::StatusOr<bool> lower = Lowers((x_ + Proposed(damping_)).cwiseMax(low_).cwiseMin(high_));
    if (!lower.ok()) return lower.status();
    damping_ = !*lower ? std::max(10 * damping_, 0.01) : damping_ > 0.01 ? damping_ / 10 : 0;
    if (*lower) return Settling::kGoesOn;
  }
  return Settling::kStuck;
}

}  // namespace phrenic::calibrate
