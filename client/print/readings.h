// A scene's measures as people read them.
#ifndef PHRENIC_CLIENT_PRINT_READINGS_H_
#define PHRENIC_CLIENT_PRINT_READINGS_H_

#include <google/protobuf/repeated_ptr_field.h>

#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "phrenic/v1/measures.pb.h"

namespace phrenic::client {

// Four digits in the unit that people use: litres for m^3, millimetres for m; "2.513 l", "0.4 l/s", "-530 Pa".
std::string ReadingText(double value, const std::string& unit);

// The last value of each measure, the least and the greatest. Not thread-safe.
class Readings {
 public:
  struct Range {
    std::string name, unit;
    double last, minimum, maximum;
  };
  const std::vector<Range>& ranges() const { return ranges_; }
  void Add(const google::protobuf::RepeatedPtrField<v1::MeasureReading>& readings);
  // A table; nothing where there are no measures.
  void Print(std::ostream& out) const;
  // In SI: [{"name", "unit", "last", "minimum", "maximum"}].
  nlohmann::json ToJson() const;

 private:
  std::vector<Range> ranges_;
};

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_PRINT_READINGS_H_
