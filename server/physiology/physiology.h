// A thorax' breath held against published ranges.
#ifndef PHRENIC_SERVER_PHYSIOLOGY_PHYSIOLOGY_H_
#define PHRENIC_SERVER_PHYSIOLOGY_PHYSIOLOGY_H_

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "phrenic/v1/study.pb.h"
#include "server/mechanics/model.h"

namespace phrenic::physiology {

// Breathes in once, from rest to the peak, by the scene's own parameters ("quiet") and by its presets "deep",
// "diaphragmatic" and "chest", where it has them, and measures at each peak. Ranges: Boussuges 2009, Wilson 1987,
// Gauthier 1994, Konno and Mead's shares. `progress` is told how much is done, 0 to 1; CANCELLED as soon as it returns
// false. FAILED_PRECONDITION for a scene without a diaphragm, OUT_OF_RANGE where a breath diverges.
absl::StatusOr<v1::PhysiologyTable> CheckPhysiology(const Model& model, absl::FunctionRef<bool(double)> progress);

}  // namespace phrenic::physiology

#endif  // PHRENIC_SERVER_PHYSIOLOGY_PHYSIOLOGY_H_
