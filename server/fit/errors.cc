#include "server/fit/errors.h"

#include <cmath>
#include <functional>
#include <limits>

#include "server/fit/sides.h"

namespace phrenic::fit {
namespace {

// Features of a model: one column per feature, one row per point.
using Features = Eigen::MatrixXd;

Features AffineFeatures(const Points& exhale) {
  const Eigen::Vector3d centre = exhale.rowwise().mean();
  Features features(exhale.cols(), 4);
  features.col(0).setOnes();
  features.rightCols<3>() = ((exhale.colwise() - centre) / 0.1).transpose();
  return features;
}

// Fits the motion along the axes from `first` on to the features, with the fitting half; the other axes stay at 0.
Points FitFeatures(const Features& features, const Points& motion, int first, const std::vector<int>& fitting) {
  const Features own = features(fitting, Eigen::all);
  const Eigen::MatrixXd matrix = own.transpose() * own;
  Points fitted = Points::Zero(3, motion.cols());
  for (int axis = first; axis < 3; ++axis) {
    const Eigen::VectorXd target = motion.row(axis)(fitting);
    fitted.row(axis) = (features * matrix.ldlt().solve(own.transpose() * target)).transpose();
  }
  return fitted;
}

struct Region {
  const char* name;
  std::function<bool(const Eigen::Vector3d& place, bool left)> holds;
};

const std::vector<Region>& Regions() {
  static const auto* const regions = new std::vector<Region>{
      {"base third", [](const Eigen::Vector3d& p, bool) { return p.z() < 1.0 / 3; }},
      {"middle third", [](const Eigen::Vector3d& p, bool) { return p.z() >= 1.0 / 3 && p.z() <= 2.0 / 3; }},
      {"top third", [](const Eigen::Vector3d& p, bool) { return p.z() > 2.0 / 3; }},
      {"front", [](const Eigen::Vector3d& p, bool) { return p.y() < 0; }},
      {"back", [](const Eigen::Vector3d& p, bool) { return p.y() >= 0; }},
      {"medial", [](const Eigen::Vector3d& p, bool) { return p.x() < 0; }},
      {"lateral", [](const Eigen::Vector3d& p, bool) { return p.x() >= 0; }},
      {"right lung", [](const Eigen::Vector3d&, bool left) { return !left; }},
      {"left lung", [](const Eigen::Vector3d&, bool left) { return left; }},
  };
  return *regions;
}

}  // namespace

ErrorSummary Summarise(const Points& difference) {
  if (difference.cols() == 0) return {std::nan(""), std::nan("")};
  const Eigen::VectorXd lengths = difference.colwise().norm().transpose();
  return {lengths.mean(), Quantile({lengths.begin(), lengths.end()}, 0.95)};
}

ErrorSummary Summarise(const Points& difference, const std::vector<int>& indices) {
  return Summarise(difference(Eigen::all, indices));
}

std::vector<Baseline> FitBaselines(const Points& exhale, const Points& motion, const Halves& halves) {
  const Features affine = AffineFeatures(exhale), z = affine(Eigen::all, {0, 3}), slope = affine(Eigen::all, {0, 2, 3});
  const auto judged = [&](const char* name, int numbers, const Points& fitted) {
    return Baseline{name, numbers, Summarise(motion - fitted, halves.held_out)};
  };
  const auto fitted = [&](const Features& features, int first) {
    return FitFeatures(features, motion, first, halves.fitting);
  };
  return {judged("no motion", 0, Points::Zero(3, motion.cols())),
          judged("rigid shift", 3, fitted(affine.leftCols<1>(), 0)), judged("line in z", 2, fitted(z, 2)),
          judged("line and front-back slope", 3, fitted(slope, 2)), judged("affine", 12, fitted(affine, 0))};
}

std::vector<RegionError> ErrorsByRegion(const Points& places, const std::vector<bool>& left, const Points& motion,
                                        const Points& difference, const std::vector<int>& indices) {
  std::vector<RegionError> errors;
  for (const Region& region : Regions()) {
    std::vector<int> inside;
    for (const int i : indices) {
      if (region.holds(places.col(i), left[static_cast<size_t>(i)])) inside.push_back(i);
    }
    if (inside.empty()) continue;
    errors.push_back(
        {region.name, static_cast<int>(inside.size()), Summarise(motion, inside).mean, Summarise(difference, inside)});
  }
  return errors;
}

}  // namespace phrenic::fit
