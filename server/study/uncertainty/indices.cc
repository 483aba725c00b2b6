#include "server/study/uncertainty/indices.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "server/study/uncertainty/percentiles.h"

namespace phrenic::study {
namespace {

constexpr int kBootstraps = 200;

// Base points all of whose runs succeeded; one per row: f(A), f(B), f(A_B^1), ...
UnitPoints CompleteBlocks(std::span<const double> values, Eigen::Index width) {
  const Eigen::Map<const UnitPoints> all(values.data(), static_cast<Eigen::Index>(values.size()) / width, width);
  UnitPoints kept(all.rows(), width);
  Eigen::Index rows = 0;
  for (Eigen::Index j = 0; j < all.rows(); ++j) {
    if (all.row(j).allFinite()) kept.row(rows++) = all.row(j);
  }
  kept.conservativeResize(rows, Eigen::NoChange);
  return kept;
}

// Returns first and total indices, 2 x inputs; NaN if the function does not vary.
Eigen::MatrixXd EstimateIndices(const UnitPoints& f) {
  const Eigen::Index inputs = f.cols() - 2;
  const double mean = f.leftCols(2).mean();
  const double variance = (f.leftCols(2).array() - mean).square().mean();
  Eigen::MatrixXd indices(2, inputs);
  if (!Varies(variance, mean)) return indices.setConstant(std::nan(""));
  for (Eigen::Index i = 0; i < inputs; ++i) {
    const auto moved = f.col(2 + i).array(), a = f.col(0).array(), b = f.col(1).array();
    indices(0, i) = ((b - mean) * (moved - a)).mean() / variance;
    indices(1, i) = (a - moved).square().mean() / (2 * variance);
  }
  return indices;
}

Interval Within(std::vector<double>& values) {
  std::erase_if(values, [](double each) { return !std::isfinite(each); });
  return {Percentile(values, 2.5), Percentile(values, 97.5)};
}

// Adds the intervals of bootstraps.
void AddIntervals(const UnitPoints& f, std::uint64_t seed, std::vector<SobolIndex>& indices) {
  std::mt19937_64 random(seed);
  std::vector<std::vector<double>> firsts(indices.size()), totals(indices.size());
  UnitPoints drawn(f.rows(), f.cols());
  for (int bootstrap = 0; bootstrap < kBootstraps; ++bootstrap) {
    for (Eigen::Index j = 0; j < f.rows(); ++j) {
      drawn.row(j) = f.row(static_cast<Eigen::Index>(random() % static_cast<std::uint64_t>(f.rows())));
    }
    const Eigen::MatrixXd estimate = EstimateIndices(drawn);
    for (size_t i = 0; i < indices.size(); ++i) {
      firsts[i].push_back(estimate(0, static_cast<Eigen::Index>(i)));
      totals[i].push_back(estimate(1, static_cast<Eigen::Index>(i)));
    }
  }
  for (size_t i = 0; i < indices.size(); ++i) {
    indices[i].first_within = Within(firsts[i]);
    indices[i].total_within = Within(totals[i]);
  }
}

}  // namespace

std::vector<Effects> ElementaryEffects(const UnitPoints& points, std::span<const double> values) {
  const Eigen::Index inputs = points.cols();
  std::vector<std::vector<double>> found(static_cast<size_t>(inputs));
  for (Eigen::Index row = 1; row < points.rows(); ++row) {
    if (row % (inputs + 1) == 0) continue;
    Eigen::Index moved = 0;
    const Eigen::RowVectorXd step = points.row(row) - points.row(row - 1);
    step.cwiseAbs().maxCoeff(&moved);
    const auto at = static_cast<size_t>(row);
    const double effect = (values[at] - values[at - 1]) / step[moved];
    if (std::isfinite(effect)) found[static_cast<size_t>(moved)].push_back(effect);
  }
  std::vector<Effects> effects(found.size());
  for (size_t i = 0; i < found.size(); ++i) {
    if (found[i].empty()) continue;
    const Eigen::Map<const Eigen::ArrayXd> each(found[i].data(), static_cast<Eigen::Index>(found[i].size()));
    effects[i] = {each.mean(), each.abs().mean(), DeviationOf(found[i]), static_cast<int>(each.size())};
  }
  return effects;
}

std::vector<SobolIndex> SobolIndices(std::span<const double> values, int inputs, std::uint64_t seed) {
  const UnitPoints f = CompleteBlocks(values, inputs + 2);
  if (f.rows() < 2) return {};
  const Eigen::MatrixXd estimate = EstimateIndices(f);
  if (!estimate.allFinite()) return {};
  std::vector<SobolIndex> indices(static_cast<size_t>(inputs));
  for (int i = 0; i < inputs; ++i) {
    indices[static_cast<size_t>(i)].first = estimate(0, i);
    indices[static_cast<size_t>(i)].total = estimate(1, i);
  }
  AddIntervals(f, seed, indices);
  return indices;
}

}  // namespace phrenic::study
