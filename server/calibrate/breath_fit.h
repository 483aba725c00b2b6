// Fits live parameters of a simulation, such as activations and compliances, to a person's data, so that the breath of
// the preset that is found has been simulated.
//
// Minimises  sum_i w_i (d_i - m_i(p, q))^2 + sum_k ((p_k - prior_k)/sd_k)^2 + sum_j (q_j/sd_j)^2
// over the parameters p, within their bounds, and the data's own numbers q, by bounded_descent.h. The derivatives by p
// are differences of breaths, simulated side by side on several threads, each from rest, so that the result does not
// depend on their number. The covariance is the inverse of half the curvature, as if there were no bounds: the standard
// error of a number at its bound (at_bound, and a doubt) is without this bound.
#ifndef PHRENIC_SERVER_CALIBRATE_BREATH_FIT_H_
#define PHRENIC_SERVER_CALIBRATE_BREATH_FIT_H_

#include <string>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "server/calibrate/breath_data.h"
#include "server/calibrate/varied.h"
#include "server/fit/joint_fit.h"

namespace phrenic::calibrate {

struct FittedParameter {
  Varied varied;
  double prior, prior_sd;  // in the field's unit
};

// Returns the prior of a parameter: its value at the start, within its bounds, with a standard deviation of its own:
//   activations +- 0.6 of the value and 0.05 at least; shares of a breath +- 0.08 (Tobin et al., Chest 84, 1983);
//   compliances +- 0.35 of the value (coefficient of variation of lung compliance between healthy people: Galetke et
//   al., Respiration 74, 2007); others a quarter of the range within their bounds.
FittedParameter PriorOf(const Varied& varied, const v1::Parameters& start);

struct BreathFit {
  std::vector<fit::FittedQuantity> numbers;  // the parameters, then the data's own
  Eigen::MatrixXd correlation;               // of them
  std::vector<fit::FittedQuantity> derived;  // tidal volume, domes, abdominal share of the simulated breath
  std::vector<fit::KindReport> kinds;
  std::vector<std::string> doubts;
  v1::Parameters parameters;  // of the breath, every field set
  int breaths = 0;            // that were simulated
  bool converged = false;  // false: the limit of iterations, or a place from which no trial went down, ended the search
};

struct BreathFitOptions {
  int iterations = 8;
  int threads = 0;  // 0: one a processor
};

// Called on the calling thread with 0..1 and what is done; false cancels.
using BreathFitProgress = absl::FunctionRef<bool(double, const std::string&)>;

// `start` has every field set. INVALID_ARGUMENT if there are no data or parameters, or one occurs twice;
// FAILED_PRECONDITION if a breath diverges, or the scene lacks what the data are of (a diaphragm; pressures for a
// volume); CANCELLED.
absl::StatusOr<BreathFit> FitBreath(const physiology::Subject& subject, const v1::Parameters& start,
                                    const std::vector<FittedParameter>& parameters, const AllBreathData& data,
                                    const BreathFitOptions& options, BreathFitProgress progress);

}  // namespace phrenic::calibrate

#endif  // PHRENIC_SERVER_CALIBRATE_BREATH_FIT_H_
