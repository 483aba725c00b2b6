#include "server/mechanics/constraints/thesis_links.h"

#include <algorithm>
#include <cmath>

namespace phrenic {

void ThesisLinks::Project(const v1::Parameters& parameters, const ConstPoints& before, double /*dt*/,
                          const Scratch& /*scratch*/, State& state) const {
  if (!parameters.apply_links()) return;
  Points& x = state.x;
  for (const Link& link : links_) {
    const Eigen::Vector3d between = x.col(link.b) - x.col(link.a);
    const double length = between.norm();
    if (length == 0 || !link.Movable()) continue;
    double a = link.inverse_a > 0 ? (x.col(link.a) - before.col(link.a)).norm() : 0;
    double b = link.inverse_b > 0 ? (x.col(link.b) - before.col(link.b)).norm() : 0;
    if (a + b == 0) a = link.inverse_a, b = link.inverse_b;  // no displacement: split by inverse mass
    const Eigen::Vector3d correction = ((length - link.length) / length) * between;
    x.col(link.a) += a / (a + b) * correction;
    x.col(link.b) -= b / (a + b) * correction;
  }
}

double ThesisLinks::Residual(const State& state) const {
  double worst = 0;
  for (const Link& link : links_) {
    if (link.Movable()) worst = std::max(worst, std::abs(link.Stretch(state.x)));
  }
  return worst;
}

}  // namespace phrenic
