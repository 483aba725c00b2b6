#include "server/study/uncertainty/percentiles.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace phrenic::study {
namespace {

constexpr double kRounding = 1e-9;  // standard deviation over the mean

}  // namespace

double Percentile(std::vector<double> values, double percent) {
  if (values.empty()) return std::nan("");
  std::sort(values.begin(), values.end());
  const double at = percent / 100 * static_cast<double>(values.size() - 1);
  const auto below = static_cast<size_t>(at);
  const size_t above = std::min(below + 1, values.size() - 1);
  return std::lerp(values[below], values[above], at - static_cast<double>(below));
}

double DeviationOf(const std::vector<double>& values) {
  if (values.size() < 2) return 0;
  const Eigen::Map<const Eigen::ArrayXd> each(values.data(), static_cast<Eigen::Index>(values.size()));
  return std::sqrt((each - each.mean()).square().sum() / static_cast<double>(values.size() - 1));
}

bool Varies(double variance, double mean) { return std::sqrt(variance) > kRounding * std::abs(mean); }

}  // namespace phrenic::study
