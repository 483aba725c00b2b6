// Live parameters that a calibration varies, by their names.
#ifndef PHRENIC_SERVER_CALIBRATE_VARIED_H_
#define PHRENIC_SERVER_CALIBRATE_VARIED_H_

#include <string>

#include "absl/status/statusor.h"
#include "phrenic/v1/options.pb.h"
#include "phrenic/v1/parameters.pb.h"

namespace phrenic::calibrate {

struct Varied {
  const google::protobuf::FieldDescriptor* field;  // of v1::Parameters, with a Quantity
  double low, high;                                // in the field's unit; low < high
};

// Parses "NAME" or "NAME:LOW:HIGH"; without numbers, the range is the field's. INVALID_ARGUMENT names the parameter,
// and lists those that there are if it is unknown, or says why it cannot be varied.
absl::StatusOr<Varied> ReadVaried(const std::string& text);

const v1::Quantity& QuantityOf(const Varied& varied);
// Returns the smallest useful change.
double StepOf(const Varied& varied);
double ValueOf(const Varied& varied, const v1::Parameters& parameters);
void SetValue(const Varied& varied, double value, v1::Parameters& parameters);

}  // namespace phrenic::calibrate

#endif  // PHRENIC_SERVER_CALIBRATE_VARIED_H_
