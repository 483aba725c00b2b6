#include "server/mechanics/integrators/catalogue.h"

#include "server/mechanics/integrators/bdf2.h"
#include "server/mechanics/integrators/explicit_euler.h"
#include "server/mechanics/integrators/linear_implicit_euler.h"
#include "server/mechanics/integrators/projective_dynamics.h"
#include "server/mechanics/integrators/rk4.h"
#include "server/mechanics/integrators/semi_implicit_euler.h"
#include "server/mechanics/integrators/static_equilibrium.h"
#include "server/mechanics/integrators/thesis_euler.h"
#include "server/mechanics/integrators/tr_bdf2.h"
#include "server/mechanics/integrators/velocity_verlet.h"

namespace phrenic {
namespace {

template <typename Kind>
const Integrator& Only() {
  static const Kind only;
  return only;
}

}  // namespace

const Integrator& FindIntegrator(v1::Integrator kind) {
  switch (kind) {
    case v1::INTEGRATOR_THESIS:
      return Only<ThesisEuler>();
    case v1::INTEGRATOR_EXPLICIT_EULER:
      return Only<ExplicitEuler>();
    case v1::INTEGRATOR_VELOCITY_VERLET:
      return Only<VelocityVerlet>();
    case v1::INTEGRATOR_RUNGE_KUTTA_4:
      return Only<Rk4>();
    case v1::INTEGRATOR_LINEAR_IMPLICIT_EULER:
      return Only<LinearImplicitEuler>();
    case v1::INTEGRATOR_BDF2:
      return Only<Bdf2>();
    case v1::INTEGRATOR_TR_BDF2:
      return Only<TrBdf2>();
    case v1::INTEGRATOR_PROJECTIVE_DYNAMICS:
      return Only<ProjectiveDynamics>();
    case v1::INTEGRATOR_STATIC:
      return Only<StaticEquilibrium>();
    case v1::INTEGRATOR_SEMI_IMPLICIT_EULER:
    case v1::INTEGRATOR_UNSPECIFIED:
    case v1::Integrator_INT_MIN_SENTINEL_DO_NOT_USE_:
    case v1::Integrator_INT_MAX_SENTINEL_DO_NOT_USE_:
      break;
  }
  return Only<SemiImplicitEuler>();
}

IntegratorTable AllIntegrators() {
  IntegratorTable table;
  for (size_t kind = 0; kind < table.size(); ++kind) table[kind] = &FindIntegrator(static_cast<v1::Integrator>(kind));
  return table;
}

}  // namespace phrenic
