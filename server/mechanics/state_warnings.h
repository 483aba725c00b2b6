// What is wrong with a state although its run goes on.
#ifndef PHRENIC_SERVER_MECHANICS_STATE_WARNINGS_H_
#define PHRENIC_SERVER_MECHANICS_STATE_WARNINGS_H_

#include <string>
#include <vector>

#include "server/mechanics/constraint_residual.h"
#include "server/mechanics/model.h"

namespace phrenic {

// Returns the warnings of the motions (Motion::Warning) in the scene's order.
std::vector<std::string> MotionWarnings(const Model& model, const State& state);

// Returns these and that of the residual (ResidualWarning): the warnings of every output. Thread-safe.
std::vector<std::string> StateWarnings(const Model& model, const v1::Parameters& parameters, const State& state,
                                       const ConstraintResidual& residual);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_STATE_WARNINGS_H_
