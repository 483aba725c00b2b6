// Compares the breathing motion of a thorax with published ranges.
#ifndef PHRENIC_SERVER_PHYSIOLOGY_PHYSIOLOGY_H_
#define PHRENIC_SERVER_PHYSIOLOGY_PHYSIOLOGY_H_

#include <span>
#include <string>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "phrenic/v1/study.pb.h"
#include "server/mechanics/model.h"

namespace phrenic::physiology {

// Simulates a breath of each preset of the scene (and "quiet", its own parameters, if it has none of that name) and of
// the changed ones of rows.h, once each, and reads every row of the table off it. With `presets`, only those and what
// their rows compare them with. What may happen in no breath is judged over all that were simulated. A breath that
// diverges is outside, with a note. `progress` gets the completed fraction, 0 to 1. Errors: CANCELLED if `progress`
// returns false, FAILED_PRECONDITION for a scene without a diaphragm, INVALID_ARGUMENT if it has no such preset.
absl::StatusOr<v1::PhysiologyTable> CheckPhysiology(const Model& model, std::span<const std::string> presets,
                                                    absl::FunctionRef<bool(double)> progress);

}  // namespace phrenic::physiology

#endif  // PHRENIC_SERVER_PHYSIOLOGY_PHYSIOLOGY_H_
