// The smallest elastic deformation of the lungs that moves points by given vectors: not a prediction from causes, but
// an interpolation by tissue.
//
// Minimises E(u) + w/2 sum |u(x_i) - r_i|^2, with E the energy of LungTissue for surroundings at rest on a soft contact
// (k/E = 5 1/m), each lung apart; w = 0.1 m.
#ifndef PHRENIC_SERVER_FIT_ASSIMILATION_H_
#define PHRENIC_SERVER_FIT_ASSIMILATION_H_

#include "absl/status/statusor.h"
#include "server/fit/person.h"

namespace phrenic::fit {

// Returns the deformation [m] at `at`, from the vectors `residual` at the points `known` [m]. The status of
// LungTissue::Make; INVALID_ARGUMENT if the system cannot be factorised.
absl::StatusOr<Points> Assimilate(const LungTemplates& templates, const RegisteredLungs& registered,
                                  const Points& known, const Points& residual, const Points& at);

}  // namespace phrenic::fit

#endif  // PHRENIC_SERVER_FIT_ASSIMILATION_H_
