// Fits a person's breath to all that there is of it: landmarks, surfaces, recordings and markers, together.
#ifndef PHRENIC_SERVER_FIT_JOINT_FIT_H_
#define PHRENIC_SERVER_FIT_JOINT_FIT_H_

#include <string>
#include <vector>

#include "server/fit/evidence.h"
#include "server/fit/fit_space.h"
#include "server/fit/joint_solve.h"
#include "server/fit/motion_fit.h"

namespace phrenic::fit {

// A number that was fitted, or one that follows from them. In SI units, but for `unit` and `per_unit`.
struct FittedQuantity {
  FitNumber number;  // with the prior: of a number that follows, what the prior leads to expect
  double value, standard_error;
  bool determined;  // the standard error is below half of the prior's standard deviation
  bool at_bound;
};

// What a kind of data says, and how well it is met. Root mean squares of the residuals, in SI units; NaN without data.
struct KindReport {
  KindOfData kind;
  int fitting, held_out;  // data
  double still;           // if nothing moves
  double before, after;   // with the prior's numbers, and with the fitted ones
  double held_out_still, held_out_after;
};

struct JointFit {
  MotionFit motion;                     // the breath; errors, baselines and points are those of landmarks at end inhale
  bool own_lungs = false;               // true: shaped by the person's points; false: the scene's
  std::vector<FittedQuantity> numbers;  // the amplitudes first
  Eigen::MatrixXd correlation;          // of them
  std::vector<FittedQuantity> derived;  // tidal volume, descents, abdominal share, rate
  std::vector<KindReport> kinds;
  double breath_length = 0, inspiratory_share = 0, pause_share = 0;  // 0: no recording says
};

// The lungs are shaped by Evidence::exhale, else by the fitting half of the landmarks if that has kFewestPoints, else
// they are the scene's, where they are in it. INVALID_ARGUMENT if there is nothing to fit, landmarks lie outside the
// lungs, or by the kinds; the errors of FitMotion. `FitOptions::assimilate` is not used. Thread-safe.
absl::StatusOr<JointFit> FitJointly(const LungTemplates& templates, const Evidence& evidence, const FitOptions& options,
                                    const FitProgress& progress = {});

}  // namespace phrenic::fit

#endif  // PHRENIC_SERVER_FIT_JOINT_FIT_H_
