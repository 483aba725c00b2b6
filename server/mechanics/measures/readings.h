// The values of all measures of a model at one moment.
#ifndef PHRENIC_SERVER_MECHANICS_MEASURES_READINGS_H_
#define PHRENIC_SERVER_MECHANICS_MEASURES_READINGS_H_

#include "google/protobuf/repeated_ptr_field.h"
#include "phrenic/v1/measures.pb.h"
#include "server/mechanics/model.h"

namespace phrenic {

using MeasureReadings = google::protobuf::RepeatedPtrField<v1::MeasureReading>;

// Returns one reading per measure, in the scene's order. Equal chambers of several measures are summed once.
// Thread-safe, for threads with scratch memory of their own.
MeasureReadings ReadMeasures(const Model& model, const EvalContext& at);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_MEASURES_READINGS_H_
