// Fits a person's breath to landmark pairs, and judges it on pairs that it has not seen.
//
// The motion of landmark i is u(x_i) = sum_m a_m u_m(x_i), with u_m the response of the person's elastic, sliding lungs
// to boundary mode m (person.h, boundary_modes.h); the amplitudes a are a linear least squares over a random half of
// the pairs, which also gives the lungs their shape. The other half is for judgement alone.
#ifndef PHRENIC_SERVER_FIT_MOTION_FIT_H_
#define PHRENIC_SERVER_FIT_MOTION_FIT_H_

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "server/fit/errors.h"
#include "server/fit/landmarks.h"
#include "server/fit/people.h"
#include "server/fit/person.h"

namespace phrenic::fit {

inline constexpr int kFewestPairs = 2 * kFewestPoints;  // half of them shape the lungs

struct FitOptions {
  int numbers = 8;          // amplitudes: 8 or 12
  std::uint64_t split = 1;  // seed of the division into halves
  bool assimilate = false;
  LungElasticity elasticity = {};
};

struct FittedNumber {
  std::string name, what;
  double value, standard_error;  // [m]
  double spread;                 // between people, for this descent [m]
  bool determined;               // the standard error is below half of the spread
};

struct MotionFit {
  RegisteredLungs registered;
  Halves halves;
  double descent = 0;  // of the lowest fifth of the fitting points [m]
  std::vector<FittedNumber> parameters;
  Eigen::MatrixXd correlation;  // of the parameters
  ErrorSummary fitting, held_out;
  std::vector<Baseline> baselines;
  std::vector<RegionError> regions;         // of the held-out half
  std::optional<ErrorSummary> assimilated;  // held-out half, with the smallest elastic deformation added
  double volume = 0;                        // change of the lungs' volume [m^3]
  Points exhale, motion, predicted;         // of all landmarks [m]; with the deformation, if assimilated
  PersonMotion person;                      // of the fitting half, for summaries of people
  Eigen::MatrixXd held_out_responses;       // Person::Responses at the held-out half
};

// Returns false to cancel. Called with the fraction done and the stage.
using FitProgress = std::function<bool(double, std::string_view)>;

// INVALID_ARGUMENT if there are no pairs or fewer than kFewestPairs, or by FindSides; the errors of Register;
// CANCELLED. The same landmarks and options give the same bits. Thread-safe.
absl::StatusOr<MotionFit> FitMotion(const LungTemplates& templates, const Landmarks& landmarks,
                                    const FitOptions& options, const FitProgress& progress = {});

}  // namespace phrenic::fit

#endif  // PHRENIC_SERVER_FIT_MOTION_FIT_H_
