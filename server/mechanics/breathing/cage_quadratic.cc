#include "server/mechanics/breathing/cage_quadratic.h"

#include <Eigen/Dense>

namespace phrenic {
namespace {

constexpr double kDeparture = 0.4;

}  // namespace

const std::vector<CagePosition>& CageFit::Positions() {
  static const auto& positions = *new std::vector<CagePosition>([] {
    std::vector<CagePosition> all;
    for (const double pump : {-0.3, 0.4, 1.0}) {
      for (const double bucket : {-0.3, 0.4, 1.0}) all.push_back({pump, bucket, {}});
    }
    return all;
  }());
  return positions;
}

CageFit::CageFit() {
  Eigen::Matrix<double, 9, 5> basis;
  for (size_t i = 0; i < Positions().size(); ++i) {
    const double p = Positions()[i].pump, b = Positions()[i].bucket;
    basis.row(static_cast<Eigen::Index>(i)) << p, b, p * p, b * b, p * b;
  }
  inverse_ = (basis.transpose() * basis).inverse() * basis.transpose();
}

std::array<CagePosition, 4> CageFit::PositionsOf(CagePart part) {
  std::array<CagePosition, 4> positions = {{{0, 0}, {0, 0}, {1, 0}, {0, 1}}};
  for (size_t i = 0; i < positions.size(); ++i) positions[i].parts[part] = i == 1 ? kDeparture : -kDeparture;
  return positions;
}

PartQuadratic CageFit::Through(const std::array<double, 4>& changes) {
  const auto& [back, out, with_pump, with_bucket] = changes;
  return {{(out - back) / (2 * kDeparture), (back - with_pump) / kDeparture, (back - with_bucket) / kDeparture,
           (out + back) / (2 * kDeparture * kDeparture)}};
}

void CageFit::Add(size_t position, double value, CageQuadratic& fit) const {
  for (size_t j = 0; j < fit.c.size(); ++j) {
    fit.c[j] += inverse_(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(position)) * value;
  }
}

}  // namespace phrenic
