#include "server/fit/fit_space.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <utility>

namespace phrenic::fit {
namespace {

constexpr double kMostAmplitude = 0.1;  // [m], as of the live parameters lung_*

}  // namespace

FitSpace::FitSpace(const std::vector<Amplitude>& amplitudes, const PeopleMotion& people) {
  const Eigen::VectorXd& mean = people.mean;
  const Eigen::MatrixXd between = people.spread.cwiseAbs2().asDiagonal();
  constexpr double kDescentVariance = kPriorDescentSd * kPriorDescentSd;
  covariance_ = kDescentVariance * (mean * mean.transpose() + between) + kPriorDescent * kPriorDescent * between;
  for (size_t k = 0; k < amplitudes.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    numbers_.push_back({amplitudes[k].Name(), BoundaryModes()[static_cast<size_t>(amplitudes[k].mode)].what, "mm", 1e-3,
                        kPriorDescent * mean[at], std::sqrt(covariance_(at, at)), -kMostAmplitude, kMostAmplitude});
  }
}

int FitSpace::Add(FitNumber number) {
  numbers_.push_back(std::move(number));
  return static_cast<int>(numbers_.size()) - 1;
}

int FitSpace::Find(const std::string& name) const {
  const auto found = std::find_if(numbers_.begin(), numbers_.end(), [&](const FitNumber& n) { return n.name == name; });
  return found == numbers_.end() ? -1 : static_cast<int>(found - numbers_.begin());
}

Eigen::VectorXd FitSpace::Mean() const {
  Eigen::VectorXd mean(size());
  for (Eigen::Index k = 0; k < size(); ++k) mean[k] = numbers_[static_cast<size_t>(k)].mean;
  return mean;
}

Eigen::MatrixXd FitSpace::Covariance() const {
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(size(), size());
  covariance.topLeftCorner(amplitudes(), amplitudes()) = covariance_;
  for (Eigen::Index k = amplitudes(); k < size(); ++k) {
    const double sd = numbers_[static_cast<size_t>(k)].sd;
    covariance(k, k) = sd * sd;
  }
  return covariance;
}

Eigen::MatrixXd FitSpace::Precision() const {
  Eigen::MatrixXd precision = Eigen::MatrixXd::Zero(size(), size());
  const Eigen::Index n = amplitudes();
  precision.topLeftCorner(n, n) = covariance_.llt().solve(Eigen::MatrixXd::Identity(n, n));
  for (Eigen::Index k = n; k < size(); ++k) {
    const double sd = numbers_[static_cast<size_t>(k)].sd;
    precision(k, k) = 1 / (sd * sd);
  }
  return precision;
}

Eigen::VectorXd FitSpace::Bounded(Eigen::VectorXd numbers) const {
  for (Eigen::Index k = 0; k < size(); ++k) {
    const FitNumber& number = numbers_[static_cast<size_t>(k)];
    numbers[k] = std::clamp(numbers[k], number.low, number.high);
  }
  return numbers;
}

}  // namespace phrenic::fit
