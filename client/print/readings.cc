#include "client/print/readings.h"

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

void PrintMeasureRanges(const MeasureRanges& measures, std::ostream& out) {
  if (measures.ranges().empty()) return;
  Table table({"measure", "last", "least", "greatest", "unit"});
  for (const MeasureRange& range : measures.ranges()) {
    const Familiar familiar = FamiliarUnit(range.unit);
    table.Add({range.name, Number(range.last, familiar), Number(range.minimum, familiar),
               Number(range.maximum, familiar), familiar.name});
  }
  table.Print(out);
}

nlohmann::json MeasureRangesJson(const MeasureRanges& measures) {
  nlohmann::json json = nlohmann::json::array();
  for (const MeasureRange& range : measures.ranges()) {
    json.push_back({{"name", range.name},
                    {"unit", range.unit},
                    {"last", range.last},
                    {"minimum", range.minimum},
                    {"maximum", range.maximum}});
  }
  return json;
}

}  // namespace phrenic::client
