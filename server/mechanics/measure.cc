#include "server/mechanics/measure.h"

#include <set>

#include "absl/strings/str_cat.h"
#include "server/mechanics/breathing/chamber.h"
#include "server/mechanics/compile/catalogue.h"

namespace phrenic {

absl::Status AddMeasures(ModelBuilder& builder) {
  std::set<std::string> names;
  for (int i = 0; i < builder.model.scene.measures_size(); ++i) {
    const v1::Measure& scene = builder.model.scene.measures(i);
    const std::string path = absl::StrCat("measures[", i, "]");
    if (!names.insert(scene.name()).second) {
      return FieldError(path + ".name", absl::StrCat("there are two measures named \"", scene.name(), "\""));
    }
    auto measure = MakeMeasure(scene, path, builder);
    if (!measure.ok()) return measure.status();
    builder.model.measures.push_back(*std::move(measure));
  }
  return absl::OkStatus();
}

// Volumes last: where a flow has been worked out, the volume is known.
MeasureReadings ReadMeasures(const Model& model, const EvalContext& at) {
  MeasureReadings readings;
  ChamberReadings shared;
  EvalContext moment = at;
  moment.readings = &shared;
  for (const auto& measure : model.measures) {
    v1::MeasureReading& reading = *readings.Add();
    reading.set_name(measure->name());
    reading.set_unit(measure->unit());
  }
  for (const bool volumes : {false, true}) {
    for (int i = 0; i < readings.size(); ++i) {
      if (model.scene.measures(i).has_volume() == volumes) readings[i].set_value(model.measures[i]->Value(moment));
    }
  }
  return readings;
}

}  // namespace phrenic
