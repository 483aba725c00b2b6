// One distance constraint between two vertices: an equality or a limit.
#ifndef PHRENIC_SERVER_MECHANICS_LINK_H_
#define PHRENIC_SERVER_MECHANICS_LINK_H_

#include <algorithm>
#include <cmath>

#include "server/mechanics/state.h"

namespace phrenic {

struct Link {
  int a, b;              // simulated vertices
  double length;         // the prescribed length, or the limit [m]
  double inverse_a = 0;  // 1/m of the ends [1/kg]; 0 if fixed or driven
  double inverse_b = 0;
  int sign = 0;  // 0: equality; 1: upper limit; -1: lower limit

  bool Movable() const { return inverse_a + inverse_b > 0; }
  // |x_b - x_a| - length [m].
  double Stretch(const ConstPoints& x) const { return (x.col(b) - x.col(a)).norm() - length; }
  // (|x_b - x_a|^2 / length^2 - 1) / 2: to first order the relative error of the length.
  double RelativeError(const ConstPoints& x) const {
    return 0.5 * ((x.col(b) - x.col(a)).squaredNorm() / (length * length) - 1);
  }
  // Returns |error| of an equality; of a limit, the part of the error that violates it, or 0.
  double Violation(double error) const { return sign == 0 ? std::abs(error) : std::max(0.0, sign * error); }
  double Violation(const ConstPoints& x) const { return Violation(RelativeError(x)); }
  // True if the limit is reached or violated.
  bool Reached(const ConstPoints& x) const { return sign * RelativeError(x) > -1e-8; }
  // Returns the rate of the length [m/s].
  double Rate(const State& state) const {
    const Eigen::Vector3d between = state.x.col(b) - state.x.col(a);
    const double now = between.norm();
    return now > 0 ? between.dot(state.v.col(b) - state.v.col(a)) / now : 0;
  }
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_LINK_H_
