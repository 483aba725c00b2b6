// Linear least squares with a small ridge, with standard errors and correlations.
#ifndef PHRENIC_SERVER_FIT_LEAST_SQUARES_H_
#define PHRENIC_SERVER_FIT_LEAST_SQUARES_H_

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "server/mesh/mesh.h"

namespace phrenic::fit {

struct Estimate {
  Eigen::VectorXd value;
  Eigen::VectorXd standard_error;  // zero unless bootstrapped
  Eigen::MatrixXd correlation;     // empty unless bootstrapped
};

// Minimises |A a - u|^2 + ridge n sum (c_k a_k)^2, with n points (three rows each), and c_k the root mean square of
// column k per point, so that the ridge does not depend on units. Requires: A has 3 n rows, n > 0.
Eigen::VectorXd LeastSquares(const Eigen::MatrixXd& a, const Eigen::VectorXd& u, double ridge);

// The same with standard errors and correlations by a bootstrap of `samples` in blocks of `block` [m]: residuals of
// neighbours are alike, over 30 to 45 mm in people, so whole blocks of points are drawn. Deterministic for a seed.
Estimate BootstrapLeastSquares(const Eigen::MatrixXd& a, const Eigen::VectorXd& u, double ridge, const Points& points,
                               std::uint64_t seed, double block = 0.04, int samples = 200);

// Returns a half of 0..count-1, drawn at random, and the rest, each in ascending order. Deterministic for a seed.
struct Halves {
  std::vector<int> fitting, held_out;
};
Halves SplitInHalves(int count, std::uint64_t seed);

}  // namespace phrenic::fit

#endif  // PHRENIC_SERVER_FIT_LEAST_SQUARES_H_
