#include "client/connection/measure_ranges.h"

#include <algorithm>

namespace phrenic::client {

void MeasureRanges::Add(const google::protobuf::RepeatedPtrField<v1::MeasureReading>& readings) {
  for (int i = 0; i < readings.size(); ++i) {
    const double value = readings[i].value();
    if (i == static_cast<int>(ranges_.size())) {
      ranges_.push_back({readings[i].name(), readings[i].unit(), value, value, value});
    }
    MeasureRange& range = ranges_[i];
    range.last = value;
    range.minimum = std::min(range.minimum, value);
    range.maximum = std::max(range.maximum, value);
  }
}

}  // namespace phrenic::client
