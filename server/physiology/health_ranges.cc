#include "server/physiology/health_ranges.h"

#include <algorithm>
#include <map>
#include <string>

#include "server/physiology/rows.h"
#include "server/physiology/static_curves.h"

namespace phrenic::physiology {
namespace {

constexpr auto kRise = v1::HealthRange::CHANGE_RISE, kFall = v1::HealthRange::CHANGE_FALL;

// What a row is, as the change of a measure.
struct Shown {
  const char* what;
  const char* measure;
  v1::HealthRange::Change change;
};

constexpr Shown kShown[] = {
    {"tidal volume", "lung volume", kRise},
    {"inspiratory capacity", "lung volume", kRise},
    {"vital capacity", "lung volume", kRise},
    {"pleural pressure, fall", "pleural pressure", kFall},
    {"transdiaphragmatic pressure, swing", "transdiaphragmatic pressure", kRise},
    {"right dome, descent at the apex", "right dome", kFall},
    {"right dome, descent at the apex or behind", "right dome", kFall},
};

double ToSi(const std::string& unit) {
  static const std::map<std::string, double> factors = {{"l", 1e-3}, {"mm", 1e-3}, {"cmH2O", 98.0665}};
  return factors.at(unit);
}

bool Measures(const v1::Scene& scene, const char* name) {
  return std::any_of(scene.measures().begin(), scene.measures().end(),
                     [name](const v1::Measure& measure) { return measure.name() == name; });
}

v1::HealthRange RangeOf(const Row& row, const Shown& shown, const v1::Scene& scene) {
  v1::HealthRange range;
  range.set_breath(row.breath);
  range.set_what(row.what);
  range.set_measure(shown.measure);
  range.set_change(shown.change);
  const Range of_body = RangeFor(row, scene.physique());
  range.set_low(ToSi(row.unit) * of_body.low);
  range.set_high(ToSi(row.unit) * of_body.high);
  range.set_source(row.source);
  return range;
}

}  // namespace

std::vector<v1::HealthRange> HealthRanges(const v1::Scene& scene) {
  std::vector<v1::HealthRange> ranges;
  if (ThoraxPressuresOf(scene) == nullptr) return ranges;
  for (const Row& row : RowsOfHealth()) {
    for (const Shown& shown : kShown) {
      const bool judged = row.high > row.low && std::string(row.what) == shown.what;
      if (judged && Measures(scene, shown.measure)) ranges.push_back(RangeOf(row, shown, scene));
    }
  }
  return ranges;
}

}  // namespace phrenic::physiology
