#include "server/mechanics/integrators/thesis_euler.h"

#include "server/mechanics/integrators/semi_implicit_euler.h"
#include "server/mechanics/step/advance.h"

namespace phrenic {
namespace {

constexpr double kDamping = 0.02;  // [kg] a step: "an experimentally chosen constant"

}  // namespace

// Each step multiplies what moves, and what pulls at it, by 1 - 0.02/m. Below 0.02 kg that turns springs round, and
// below 0.01 kg it makes free motion grow; above, it adds a little to semi-implicit Euler's limit.
double ThesisEuler::MaxStep(const Spectrum& spectrum) const {
  const double least = spectrum.omega_max > 0 ? kDamping : kDamping / 2;
  return spectrum.least_mass < least ? 0 : SemiImplicitEuler().MaxStep(spectrum);
}

absl::Status ThesisEuler::Advance(const Model& model, const v1::Parameters& parameters, double dt, State& state,
                                  Workspace& work) const {
  DriveMotions(model, parameters, dt, state);
  SumForces(model, MakeEvalContext(model, parameters, state), work.force);
  for (Eigen::Index i = 0; i < state.x.cols(); ++i) {
    if (model.inverse_mass[i] == 0) continue;  // fixed, or set by a motion
    state.v.col(i) += dt * model.inverse_mass[i] * work.force.col(i);
    state.v.col(i) -= kDamping * model.inverse_mass[i] * state.v.col(i);
    state.x.col(i) += dt * state.v.col(i);
  }
  ProjectPositions(model, parameters, work.before, dt, state);
  return absl::OkStatus();
}

}  // namespace phrenic
