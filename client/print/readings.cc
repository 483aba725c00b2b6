#include "client/print/readings.h"

#include <algorithm>

#include "absl/strings/str_format.h"
#include "client/print/table.h"

namespace phrenic::client {
namespace {

struct Familiar {
  const char* unit;
  double factor;
  const char* name;
};

Familiar FamiliarUnit(const std::string& unit) {
  for (const Familiar& familiar : {Familiar{"m", 1e3, "mm"}, {"m^3", 1e3, "l"}, {"m^3/s", 1e3, "l/s"}}) {
    if (unit == familiar.unit) return familiar;
  }
  return {"", 1, unit.c_str()};
}

std::string Number(double value, const Familiar& familiar) { return absl::StrFormat("%.4g", familiar.factor * value); }

}  // namespace

std::string ReadingText(double value, const std::string& unit) {
  const Familiar familiar = FamiliarUnit(unit);
  return Number(value, familiar) + " " + familiar.name;
}

void Readings::Add(const google::protobuf::RepeatedPtrField<v1::MeasureReading>& readings) {
  for (int i = 0; i < readings.size(); ++i) {
    const double value = readings[i].value();
    if (i == static_cast<int>(ranges_.size())) {
      ranges_.push_back({readings[i].name(), readings[i].unit(), value, value, value});
    }
    Range& range = ranges_[i];
    range.last = value;
    range.minimum = std::min(range.minimum, value);
    range.maximum = std::max(range.maximum, value);
  }
}

void Readings::Print(std::ostream& out) const {
  if (ranges_.empty()) return;
  Table table({"measure", "last", "least", "greatest", "unit"});
  for (const Range& range : ranges_) {
    const Familiar familiar = FamiliarUnit(range.unit);
    table.Add({range.name, Number(range.last, familiar), Number(range.minimum, familiar),
               Number(range.maximum, familiar), familiar.name});
  }
  table.Print(out);
}

nlohmann::json Readings::ToJson() const {
  nlohmann::json json = nlohmann::json::array();
  for (const Range& range : ranges_) {
    json.push_back({{"name", range.name},
                    {"unit", range.unit},
                    {"last", range.last},
                    {"minimum", range.minimum},
                    {"maximum", range.maximum}});
  }
  return json;
}

}  // namespace phrenic::client
