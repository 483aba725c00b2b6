// Converts a State to bytes and back, bit for bit.
#ifndef PHRENIC_SERVER_STORE_SAVED_STATE_H_
#define PHRENIC_SERVER_STORE_SAVED_STATE_H_

#include "absl/status/statusor.h"
#include "phrenic/v1/saved.pb.h"
#include "server/mechanics/model.h"

namespace phrenic::store {

v1::SavedState Save(const State& state);

// Returns the saved numbers as a state of no certain model, without the integrator's memory and without scalar
// coordinates. DATA_LOSS if they are not whole: velocities of other vertices than positions, or a pose of other than 13
// numbers.
absl::StatusOr<State> ReadState(const v1::SavedState& saved);

// DATA_LOSS if `saved` is not a state of the model: other numbers of vertices or poses, or a vertex that does not
// exist.
absl::StatusOr<State> Restore(const Model& model, const v1::SavedState& saved);

}  // namespace phrenic::store

#endif  // PHRENIC_SERVER_STORE_SAVED_STATE_H_
