#include "server/physiology/lung_regions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace phrenic::physiology {
namespace {

// The regions that hold a place in the lung's box, 0..1.
std::vector<LungRegion> RegionsAt(const Eigen::Vector3d& at) {
  std::vector<LungRegion> regions = {
      static_cast<LungRegion>(kLungBase + std::clamp(static_cast<int>(3 * at.z()), 0, 2))};
  if (at.y() > 2.0 / 3) regions.push_back(kLungBack);
  if (at.y() <= 1.0 / 3) regions.push_back(kLungFront);
  return regions;
}

// The middle of a part of a brick, in edges.
Eigen::Vector3d MiddleOf(int part) {
  const Eigen::Vector3i index(part % kBrickSplit, part / kBrickSplit % kBrickSplit, part / (kBrickSplit * kBrickSplit));
  return (index.cast<double>().array() + 0.5) / kBrickSplit;
}

class WeightSums {
 public:
  WeightSums(const BrickGrid& grid, const Eigen::AlignedBox3d& box) : grid_(grid), box_(box) {
    const Eigen::Index columns = 3 * grid.nodes().cols();
    weights_.caudal = weights_.gained = Eigen::MatrixXd::Zero(kLungRegions, columns);
    weights_.volume = Eigen::RowVectorXd::Zero(columns);
  }

  // Adds a part of a brick, of which `fraction` is inside.
  void Add(const BrickCorners& corners, const Eigen::Vector3d& local, double fraction) {
    const double volume = fraction * std::pow(grid_.edge() / kBrickSplit, 3);
    const BrickWeights weights = WeightsAt(local);
    const BrickGradients gradients = GradientsAt(local) / grid_.edge();
    const Eigen::Vector3d point = grid_.nodes().col(corners[0]) + grid_.edge() * local;
    const auto regions = RegionsAt((point - box_.min()).cwiseQuotient(box_.sizes()));
    for (const LungRegion region : regions) volumes_[region] += volume;
    for (int c = 0; c < 8; ++c) {
      for (const LungRegion region : regions) weights_.caudal(region, 3 * corners[c] + 2) -= volume * weights[c];
      for (int axis = 0; axis < 3; ++axis) {
        const double part = volume * gradients(axis, c);
        weights_.volume[3 * corners[c] + axis] += part;
        for (const LungRegion region : regions) weights_.gained(region, 3 * corners[c] + axis) += part;
      }
    }
  }

  RegionWeights Means() {
    for (Eigen::Index r = 0; r < kLungRegions; ++r) {
      const double volume = volumes_[static_cast<size_t>(r)];
      if (volume <= 0) continue;
      weights_.caudal.row(r) /= volume;
      weights_.gained.row(r) /= volume;
    }
    return std::move(weights_);
  }

 private:
  const BrickGrid& grid_;
  const Eigen::AlignedBox3d& box_;
  RegionWeights weights_;
  std::array<double, kLungRegions> volumes_ = {};
};

}  // namespace

RegionWeights WeightsOfRegions(const BrickGrid& grid, const Eigen::AlignedBox3d& box) {
  WeightSums sums(grid, box);
  for (size_t b = 0; b < grid.bricks().size(); ++b) {
    for (int part = 0; part < kBrickParts; ++part) {
      const double fraction = grid.fractions()[b][static_cast<size_t>(part)];
      if (fraction > 0) sums.Add(grid.bricks()[b], MiddleOf(part), fraction);
    }
  }
  return sums.Means();
}

}  // namespace phrenic::physiology
