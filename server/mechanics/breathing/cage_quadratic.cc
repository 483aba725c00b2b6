#include "server/mechanics/breathing/cage_quadratic.h"

#include <Eigen/Dense>

namespace phrenic {

const std::vector<CagePosition>& CageFit::Positions() {
  static const auto& positions = *new std::vector<CagePosition>([] {
    std::vector<CagePosition> all;
    for (const double pump : {-0.3, 0.4, 1.0}) {
      for (const double bucket : {-0.3, 0.4, 1.0}) all.push_back({pump, bucket});
    }
    return all;
  }());
  return positions;
}

CageFit::CageFit() {
  Eigen::Matrix<double, 9, 5> basis;
  for (size_t i = 0; i < Positions().size(); ++i) {
    const auto [p, b] = Positions()[i];
    basis.row(static_cast<Eigen::Index>(i)) << p, b, p * p, b * b, p * b;
  }
  inverse_ = (basis.transpose() * basis).inverse() * basis.transpose();
}

void CageFit::Add(size_t position, double value, CageQuadratic& fit) const {
  for (size_t j = 0; j < fit.c.size(); ++j) {
    fit.c[j] += inverse_(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(position)) * value;
  }
}

}  // namespace phrenic
