// The family of measures: numbers that people read off a run. To add one: a file in measures/, a message in
// measures.proto, its case in catalogue.cc, its line in tests/contract.
#ifndef PHRENIC_SERVER_MECHANICS_MEASURE_H_
#define PHRENIC_SERVER_MECHANICS_MEASURE_H_

#include <google/protobuf/repeated_ptr_field.h>

#include <string>

#include "absl/status/status.h"
#include "phrenic/v1/measures.pb.h"
#include "server/mechanics/eval_context.h"

namespace phrenic {

// A function of one instant of a run: it changes nothing, and is worked out with frames, not with steps. Immutable; any
// number of threads may call.
class Measure {
 public:
  virtual ~Measure() = default;
  const std::string& name() const { return name_; }
  const std::string& unit() const { return unit_; }  // SI, as in tables: "m^3/s"

  virtual double Value(const EvalContext& at) const = 0;

 protected:
  Measure(std::string name, std::string unit) : name_(std::move(name)), unit_(std::move(unit)) {}

 private:
  std::string name_, unit_;
};

struct ModelBuilder;
struct Model;

// Fills the measures; bodies and forces are there.
absl::Status AddMeasures(ModelBuilder& builder);

using MeasureReadings = google::protobuf::RepeatedPtrField<v1::MeasureReading>;
// All measures of the model, in the scene's order.
MeasureReadings ReadMeasures(const Model& model, const EvalContext& at);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_MEASURE_H_
