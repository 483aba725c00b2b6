// The numbers that fit all of a person's data best, with their uncertainty.
//
// Minimises 1/2 sum w r^2 + 1/2 (x - m)' P (x - m) within bounds, with m and P the prior's mean and precision, by
// Levenberg and Marquardt's damped Gauss-Newton steps (More, Lecture Notes in Mathematics 630, 1978); numbers at a
// bound that would leave it are held. Surfaces choose their points again between minimisations. The uncertainty is that
// of the linear model at the minimum: the inverse of J' W J + P. So more data never make a number less certain.
#ifndef PHRENIC_SERVER_FIT_JOINT_SOLVE_H_
#define PHRENIC_SERVER_FIT_JOINT_SOLVE_H_

#include <functional>

#include "absl/status/statusor.h"
#include "server/fit/fit_space.h"
#include "server/fit/residuals.h"

namespace phrenic::fit {

struct JointSolution {
  Eigen::VectorXd numbers;
  Eigen::MatrixXd covariance;
};

// CANCELLED if `stop` returns true between two steps. Draws no random numbers: the same data give the same bits.
absl::StatusOr<JointSolution> SolveJointly(const FitSpace& space, const AllResiduals& all,
                                           const std::function<bool()>& stop = {});

}  // namespace phrenic::fit

#endif  // PHRENIC_SERVER_FIT_JOINT_SOLVE_H_
