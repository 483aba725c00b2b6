#include "server/mechanics/measures/readings.h"

#include "server/mechanics/breathing/chamber.h"

namespace phrenic {

// Evaluates volumes last, because a flow of the same chamber also yields its volume.
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
