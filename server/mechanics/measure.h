// The family of measures. To add one: a file in measures/, a message in measures.proto, its case in
// compile/catalogue.cc, its line in tests/contract.
#ifndef PHRENIC_SERVER_MECHANICS_MEASURE_H_
#define PHRENIC_SERVER_MECHANICS_MEASURE_H_

#include <string>
#include <utility>

#include "server/mechanics/eval_context.h"

namespace phrenic {

// A number computed from one moment of a run, such as a volume. Measures are read with frames and cost no step
// (measures/readings.h). Immutable and thread-safe.
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

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_MEASURE_H_
