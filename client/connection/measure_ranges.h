// The last, smallest and greatest value of each of a scene's measures during a run.
#ifndef PHRENIC_CLIENT_CONNECTION_MEASURE_RANGES_H_
#define PHRENIC_CLIENT_CONNECTION_MEASURE_RANGES_H_

#include <google/protobuf/repeated_ptr_field.h>

#include <string>
#include <vector>

#include "phrenic/v1/measures.pb.h"

namespace phrenic::client {

struct MeasureRange {
  std::string name, unit;  // SI unit, such as "m^3"
  double last, minimum, maximum;
};

// Not thread-safe.
class MeasureRanges {
 public:
  // Requires: each call has the same measures in the same order.
  void Add(const google::protobuf::RepeatedPtrField<v1::MeasureReading>& readings);
  // One per measure; empty if the scene has no measures.
  const std::vector<MeasureRange>& ranges() const { return ranges_; }

 private:
  std::vector<MeasureRange> ranges_;
};

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CONNECTION_MEASURE_RANGES_H_
