#include "server/mechanics/integrators/semi_implicit_euler.h"

#include <cmath>
#include <limits>

#include "server/mechanics/step/step_plan.h"

namespace phrenic {

double SemiImplicitEuler::MaxStep(const Spectrum& spectrum) const {
  const double omega2 = spectrum.omega_max * spectrum.omega_max, c = spectrum.damping_rate;
  if (omega2 == 0) return c > 0 ? 2 / c : std::numeric_limits<double>::infinity();
  return 4 / (c + std::sqrt(c * c + 4 * omega2));
}

absl::Status SemiImplicitEuler::Advance(const StepPlan& plan, const v1::Parameters& parameters, double dt, State& state,
                                        Workspace& work) const {
  plan.KeepStart(state, work);
  plan.DriveMotions(parameters, dt, work.scratch, state);
  const BlockContext at = plan.PrepareBlocks(parameters, state, work);
  const StepEnd end = plan.ChooseEnd(state, work);
  plan.ForEachBlock([&](const VertexRange& block) {
    BlockMemory memory;
    const BlockForces forces = plan.SumForces(block, at, work, memory);
    plan.RecordStart(block, at, memory);
    const StateBounds moved = KickAndDrift(block, plan.model().inverse_mass, dt, dt, forces.sum, forces.loads, state.x,
                                           state.v, end.x, end.v);
    const StateBounds projected = plan.ProjectWithinBlock(block, at, memory, dt, end, moved);
    plan.RecordBounds(block, projected, work);
  });
  plan.ApplySharedDamping(dt, state, end, work);
  plan.TakeEnd(end, state, work);
  plan.ProjectAcrossBlocks(parameters, dt, state, work);
  return absl::OkStatus();
}

}  // namespace phrenic
