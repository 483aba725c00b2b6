// A state from the arrays that a caller sends.
#ifndef PHRENIC_SERVER_STUDY_BATCH_START_STATE_H_
#define PHRENIC_SERVER_STUDY_BATCH_START_STATE_H_

#include <string>

#include "phrenic/v1/state.pb.h"
#include "server/mechanics/model.h"

namespace phrenic::study {

// Returns the state with these positions, velocities and scalars, driven bodies where the motions have them.
// INVALID_ARGUMENT "PATH.positions: ..." if an array has not the length of the model's, or a number is not finite or
// out of bounds.
absl::StatusOr<State> StartState(const Model& model, const v1::Parameters& parameters, const v1::StateArrays& arrays,
                                 const std::string& path);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_BATCH_START_STATE_H_
