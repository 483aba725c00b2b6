#include "server/anatomy/physique_inverse.h"

#include <Eigen/LU>

namespace phrenic::anatomy {
namespace {

constexpr double kClose = 0.01;       // [mm]
constexpr double kDifference = 0.05;  // for derivatives [mm]
constexpr double kConverges = 0.3;    // of the distance may be left after a step with an earlier derivative
constexpr double kLongestStep = 40;   // [mm]
constexpr int kMostSteps = 40;

}  // namespace

PhysiqueInverse::PhysiqueInverse(const PhysiqueMap& map) : map_(map), adult_(0, 0, 200), image_(map(adult_)) {
  Differentiate();
}

void PhysiqueInverse::Differentiate() {
  Eigen::Matrix3d slopes;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d by = kDifference * Eigen::Vector3d::Unit(i);
    slopes.col(i) = (map_(adult_ + by) - map_(adult_ - by)) / (2 * kDifference);
  }
  step_ = slopes.inverse();
}

Eigen::Vector3d PhysiqueInverse::operator()(const Eigen::Vector3d& person) {
  for (int i = 0; i < kMostSteps; ++i) {
    const Eigen::Vector3d away = person - image_;
    const double distance = away.norm();
    if (distance < kClose) break;
    Eigen::Vector3d step = step_ * away;
    if (const double length = step.norm(); length > kLongestStep) step *= kLongestStep / length;
    adult_ += step;
    image_ = map_(adult_);
    if ((person - image_).norm() > kConverges * distance) Differentiate();
  }
  return adult_;
}

}  // namespace phrenic::anatomy
