// Polynomial chaos: a function of inputs that are uniform in the unit cube as a sum of products of Legendre
// polynomials, f(u) = sum over a of c_a prod_i sqrt(2 a_i + 1) P_(a_i)(2 u_i - 1), all of total degree `degree` or
// less, fitted by least squares. Mean, variance and Sobol indices are sums of squares of the coefficients (Sudret,
// Reliab Eng Syst Saf 2008;93:964). Stateless; thread-safe.
#ifndef PHRENIC_SERVER_STUDY_UNCERTAINTY_CHAOS_H_
#define PHRENIC_SERVER_STUDY_UNCERTAINTY_CHAOS_H_

#include <span>
#include <vector>

#include "server/study/uncertainty/indices.h"

namespace phrenic::study {

// Returns the number of coefficients: inputs + degree over degree.
double CountTerms(int inputs, int degree);

struct ChaosFit {
  int terms = 0, runs = 0;
  double mean = 0, deviation = 0;
  // 1 - mean square of the errors at points that were left out of the fit, one at a time, over the variance. 0 or less:
  // the polynomials predict nothing.
  double predicted_share = 0;
  std::vector<SobolIndex> indices;  // one per input; empty if f does not vary
};

// Fits the values at `points`; those that are not finite are left out. `indices` is empty, and `terms` 0, if less than
// one run more than terms is left.
ChaosFit FitChaos(const UnitPoints& points, std::span<const double> values, int degree);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_UNCERTAINTY_CHAOS_H_
