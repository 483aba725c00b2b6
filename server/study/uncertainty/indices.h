// How much each input of a function matters, from its values at the points of samples.h. A value that is not finite is
// that of a run that failed: what depends on it is left out. Stateless; thread-safe.
#ifndef PHRENIC_SERVER_STUDY_UNCERTAINTY_INDICES_H_
#define PHRENIC_SERVER_STUDY_UNCERTAINTY_INDICES_H_

#include <optional>
#include <span>
#include <vector>

#include "server/study/uncertainty/samples.h"

namespace phrenic::study {

// The elementary effects of one input, d = (f(x + step) - f(x))/step [unit of f].
struct Effects {
  double mean = 0;       // of d
  double mean_size = 0;  // of |d|
  double deviation = 0;  // sample standard deviation of d; 0 of a single one
  int count = 0;         // 0: none could be computed
};
// Returns one per input. Requires: `values` at the rows of `points` = MorrisPoints(...).
std::vector<Effects> ElementaryEffects(const UnitPoints& points, std::span<const double> values);

struct Interval {
  double low, high;
};
// Sobol indices of one input: the part of the variance due to it alone, and with its interactions.
struct SobolIndex {
  double first = 0, total = 0;
  std::optional<Interval> first_within, total_within;  // of 95 % of the bootstraps; none by chaos
};
// Returns one per input: first by Saltelli's estimator, sum f(B) (f(A_B^i) - f(A))/(N V), total by Jansen's,
// sum (f(A) - f(A_B^i))^2/(2 N V), with V the variance of f(A) and f(B). Empty if f does not vary, or if less than two
// base points are left. Requires: `values` at the rows of SaltelliPoints(values.size()/(inputs + 2), inputs, ...).
// Bootstraps draw base points by `seed`.
std::vector<SobolIndex> SobolIndices(std::span<const double> values, int inputs, std::uint64_t seed);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_UNCERTAINTY_INDICES_H_
