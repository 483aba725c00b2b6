#include "server/physiology/physiology.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "server/physiology/judgement.h"
#include "server/physiology/plan.h"
#include "server/physiology/recording.h"

namespace phrenic::physiology {
namespace {

struct CurveName {
  Quantity quantity;
  const char* what;
  const char* unit;
  double scale;   // from SI
  bool relative;  // to the beginning of the breath
};

constexpr CurveName kCurves[] = {
    {kVolume, "lung volume", "l", 1e3, false},
    {kFlow, "flow", "l/s", 1e3, false},
    {kPleural, "pleural pressure", "cmH2O", 1 / 98.0665, false},
    {kAbdominal, "abdominal pressure", "cmH2O", 1 / 98.0665, false},
    {kTransdiaphragmatic, "transdiaphragmatic pressure", "cmH2O", 1 / 98.0665, false},
    {kRightApex, "right dome, apex", "mm", 1e3, true},
    {kRightBack, "right dome, 40 mm behind", "mm", 1e3, true},
    {kLeftApex, "left dome, apex", "mm", 1e3, true},
    {kLeftBack, "left dome, 40 mm behind", "mm", 1e3, true},
};

void AddCurves(const Recording& recording, v1::PhysiologyTable& table) {
  for (const CurveName& each : kCurves) {
    const auto& values = recording.of[each.quantity];
    if (values.empty() || !std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); }))
      continue;
    v1::PhysiologyCurve& curve = *table.add_curves();
    curve.set_breath(recording.breath);
    curve.set_what(each.what);
    curve.set_unit(each.unit);
    for (size_t i = 0; i < values.size(); ++i) {
      curve.add_time_s(recording.time[i]);
      curve.add_values(each.scale * (values[i] - (each.relative ? values.front() : 0)));
    }
  }
}

}  // namespace

absl::StatusOr<v1::PhysiologyTable> CheckPhysiology(const Model& model, std::span<const std::string> presets,
                                                    absl::FunctionRef<bool(double)> progress) {
  const auto subject = Subject::Of(model);
  if (!subject.ok()) return subject.status();
  const auto breaths = PlanBreaths(**subject, presets);
  if (!breaths.ok()) return breaths.status();
  std::vector<Recording> recordings;
  const double fraction = 1.0 / static_cast<double>(std::max<size_t>(1, breaths->size()));
  for (const PlannedBreath& breath : *breaths) {
    const auto part = [&](double done) { return progress(fraction * (static_cast<double>(recordings.size()) + done)); };
    auto recording = Record(**subject, breath.name, breath.parameters, part);
    if (!recording.ok()) return recording.status();
    recordings.push_back(*std::move(recording));
  }
  v1::PhysiologyTable table;
  table.set_scene(model.scene.name());
  AddRows(**subject, recordings, presets, table);
  for (const Recording& recording : recordings) AddCurves(recording, table);
  return table;
}

}  // namespace phrenic::physiology
