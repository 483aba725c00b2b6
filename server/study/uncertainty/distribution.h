// The distribution of an uncertain input, by its quantile function.
#ifndef PHRENIC_SERVER_STUDY_UNCERTAINTY_DISTRIBUTION_H_
#define PHRENIC_SERVER_STUDY_UNCERTAINTY_DISTRIBUTION_H_

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "phrenic/v1/uncertainty.pb.h"
#include "server/calibrate/varied.h"

namespace phrenic::study {

// A live parameter with its distribution. Immutable, thread-safe.
struct Input {
  calibrate::Varied varied;               // bounds: those of the distribution
  std::string kind;                       // "uniform", "normal"
  std::string source;                     // where it is from
  std::function<double(double)> inverse;  // of the uncut distribution function
  double first, last;                     // its values at the bounds, within 0 to 1

  // Returns the value below which a part p of the cut distribution lies; p is within 0 to 1.
  double Quantile(double p) const;
};

inline constexpr double kTail = 0.001;  // part of a distribution that is cut off at each end that has no bound

// Normal and log-normal distributions lose a thousandth at each end and what lies outside the parameter's range.
// INVALID_ARGUMENT with the path "inputs[1].uniform.low" if the parameter does not exist, is no number or occurs twice,
// or if the distribution is not set, empty or outside the parameter's range.
absl::StatusOr<std::vector<Input>> MakeInputs(const google::protobuf::RepeatedPtrField<v1::UncertainInput>& inputs);

// Sets the inputs to their values at the quantiles p, one each.
void SetInputs(const std::vector<Input>& inputs, std::span<const double> p, v1::Parameters& parameters);

// Returns the rows of the inputs for a table. `nominal` has every field set.
google::protobuf::RepeatedPtrField<v1::InputRow> InputRows(const std::vector<Input>& inputs,
                                                           const v1::Parameters& nominal);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_UNCERTAINTY_DISTRIBUTION_H_
