#include "server/mechanics/integrators/thesis_euler.h"

#include "server/mechanics/advance.h"
#include "server/mechanics/integrators/semi_implicit_euler.h"

namespace phrenic {
namespace {

constexpr double kDampingFactor = -0.02;  // [kg] a step: "an experimentally chosen constant"

}  // namespace

// That of semi-implicit Euler, to which the damping per step adds a little for masses above 0.01 kg.
double ThesisEuler::MaxStep(const Spectrum& spectrum) const { return SemiImplicitEuler().MaxStep(spectrum); }

absl::Status ThesisEuler::Advance(const Model& model, const v1::Parameters& parameters, double dt, State& state,
                                  Workspace& work) const {
  DriveMotions(model, parameters, dt, state);
  SumForces(model, MakeInstant(model, parameters, state), work.force);
  for (Eigen::Index i = 0; i < state.x.cols(); ++i) {
    if (model.inverse_mass[i] == 0) continue;  // fixed, or set by a motion
    state.v.col(i) += dt * model.inverse_mass[i] * work.force.col(i);
    state.v.col(i) += kDampingFactor * model.inverse_mass[i] * state.v.col(i);
    state.x.col(i) += dt * state.v.col(i);
  }
  ProjectPositions(model, parameters, work.before, dt, state);
  return absl::OkStatus();
}

}  // namespace phrenic
