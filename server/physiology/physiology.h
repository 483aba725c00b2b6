// Compares the breathing motion of a thorax with published ranges.
#ifndef PHRENIC_SERVER_PHYSIOLOGY_PHYSIOLOGY_H_
#define PHRENIC_SERVER_PHYSIOLOGY_PHYSIOLOGY_H_

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "phrenic/v1/study.pb.h"
#include "server/mechanics/model.h"

namespace phrenic::physiology {

// Simulates one inspiration from rest to its peak with the scene's own parameters ("quiet") and with each of the
// presets "deep", "diaphragmatic" and "chest" that the scene has, and measures the state at the peak. The verdict of a
// row is inside, outside or not modelled. Sources of the ranges: Boussuges 2009 (dome motion), Wilson 1987 (ribs),
// Gauthier 1994 (fibres), Konno and Mead (abdominal and chest volumes). `progress` gets the completed fraction, 0 to 1.
// Errors: CANCELLED if `progress` returns false, FAILED_PRECONDITION for a scene without a diaphragm, OUT_OF_RANGE if a
// breath diverges.
absl::StatusOr<v1::PhysiologyTable> CheckPhysiology(const Model& model, absl::FunctionRef<bool(double)> progress);

}  // namespace phrenic::physiology

#endif  // PHRENIC_SERVER_PHYSIOLOGY_PHYSIOLOGY_H_
