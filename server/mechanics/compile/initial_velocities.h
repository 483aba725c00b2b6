// Initial velocities of deformable bodies.
#ifndef PHRENIC_SERVER_MECHANICS_COMPILE_INITIAL_VELOCITIES_H_
#define PHRENIC_SERVER_MECHANICS_COMPILE_INITIAL_VELOCITIES_H_

#include "absl/status/status.h"
#include "server/mechanics/model_builder.h"

namespace phrenic {

// Sets Model::initial_velocity from the bodies' `initial_velocity`; leaves it empty if no body has one.
// INVALID_ARGUMENT names the field: of a body that is not deformable, an unknown or fixed vertex, a speed above 10 km/s
// or one that is no number. Requires: masses and fixed vertices are final.
absl::Status AddInitialVelocities(ModelBuilder& builder);

// Removes the part of Model::initial_velocity that the rigid links forbid. Requires: the model has a plan.
void ProjectInitialVelocities(Model& model);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_COMPILE_INITIAL_VELOCITIES_H_
