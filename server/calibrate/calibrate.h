// Finds live parameters at which a settled breath has the wanted measures.
#ifndef PHRENIC_SERVER_CALIBRATE_CALIBRATE_H_
#define PHRENIC_SERVER_CALIBRATE_CALIBRATE_H_

#include <string>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "server/calibrate/search.h"
#include "server/calibrate/target.h"
#include "server/calibrate/varied.h"

namespace phrenic::calibrate {

struct Wanted {
  const Target* target;
  double value;  // in the target's unit
};

struct Task {
  std::vector<Wanted> wanted;
  std::vector<Varied> varied;
  SearchLimits limits;  // tolerance: of (got - wanted)/max(|wanted|, Target::least_size)
};

struct FoundParameter {
  Varied varied;
  double start, value;  // in the field's unit; the start is within the bounds
};

struct FoundMeasure {
  Wanted wanted;
  double got;        // NaN if it cannot be measured
  double deviation;  // relative
};

struct Calibration {
  std::vector<FoundParameter> parameters;
  std::vector<FoundMeasure> measures;  // of the breath of the parameters found
  double residual = 0;                 // the largest deviation, without sign
  int breaths = 0;                     // that were tried
  bool reached = false;                // true if the residual is within the tolerance
  std::string reason;                  // why not, with the bounds at which the search stopped; empty if reached
};

// INVALID_ARGUMENT if nothing is wanted, if a parameter or a target occurs twice, or if more parameters are varied than
// measures are wanted: then any number of breaths fit.
absl::Status CheckTask(const Task& task);

// Tries breaths, each from the model's state at rest and settled as physiology::Record does it, that begin with
// `start` (every field set), a value outside its bounds moved to the nearest. Returns the nearest breath also if it is
// not near enough. `progress` gets the number of breaths tried and the least residual, many times in a breath. The same
// task gives the same bits. Errors: those of CheckTask; FAILED_PRECONDITION if the scene lacks what a target is
// measured on, or if no measure of the first breath exists; CANCELLED if `progress` returns false.
absl::StatusOr<Calibration> Calibrate(const physiology::Subject& subject, const v1::Parameters& start, const Task& task,
                                      absl::FunctionRef<bool(int, double)> progress);

}  // namespace phrenic::calibrate

#endif  // PHRENIC_SERVER_CALIBRATE_CALIBRATE_H_
