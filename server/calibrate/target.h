// What a breath can be calibrated to: the measures of physiology/measures.h, in the units of people.
#ifndef PHRENIC_SERVER_CALIBRATE_TARGET_H_
#define PHRENIC_SERVER_CALIBRATE_TARGET_H_

#include <span>

#include "server/physiology/plan.h"

namespace phrenic::calibrate {

struct Target {
  const char* name;   // "tidal-volume"
  const char* unit;   // "1" for a pure number
  const char* help;   // what is measured
  double low, high;   // values that may be wanted
  double least_size;  // the least size to which a deviation is related, for wanted values near 0
  double scale;       // from the unit of the measure to this one
  physiology::BreathMeasure measure;
  physiology::Needs needs;
};

// Returns every target. The pointers to them stay valid.
std::span<const Target> Targets();

}  // namespace phrenic::calibrate

#endif  // PHRENIC_SERVER_CALIBRATE_TARGET_H_
