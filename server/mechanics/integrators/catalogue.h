// The catalogue of integrators: which value of v1::Integrator is which method. A value without its case does not
// compile.
#ifndef PHRENIC_SERVER_MECHANICS_INTEGRATORS_CATALOGUE_H_
#define PHRENIC_SERVER_MECHANICS_INTEGRATORS_CATALOGUE_H_

#include "server/mechanics/integrator.h"

namespace phrenic {

// Returns the integrator; semi-implicit Euler if it is unspecified or unknown. Thread-safe.
const Integrator& FindIntegrator(v1::Integrator kind);

// Returns all of them, for StepPlan.
IntegratorTable AllIntegrators();

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_INTEGRATORS_CATALOGUE_H_
