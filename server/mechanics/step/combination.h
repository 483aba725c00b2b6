// Which integrators run with which constraints.
#ifndef PHRENIC_SERVER_MECHANICS_STEP_COMBINATION_H_
#define PHRENIC_SERVER_MECHANICS_STEP_COMBINATION_H_

#include "absl/status/status.h"
#include "server/mechanics/model.h"

namespace phrenic {

// FAILED_PRECONDITION with a remedy for an implicit integrator with rigid links of PROJECTION_THESIS: that projection
// moves positions after the step and leaves velocities, so that steps which are stable without it gain energy. OK if
// links are switched off.
absl::Status CheckCombination(const Model& model, const Integrator& integrator, const v1::Parameters& parameters);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_STEP_COMBINATION_H_
