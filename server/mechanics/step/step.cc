#include "server/mechanics/step/step.h"

#include <algorithm>

#include "server/mechanics/step/adaptive_step.h"
#include "server/mechanics/step/bounds.h"
#include "server/mechanics/step/combination.h"
#include "server/mechanics/step/step_plan.h"

namespace phrenic {
namespace {

void CopyStart(const StepPlan& plan, const State& state, Workspace& work) {
  plan.ForEachBlock([&](const VertexRange& block) {
    const Eigen::Index first = 3 * block.first, count = 3 * (block.end - block.first);
    std::copy_n(state.x.data() + first, count, work.before.data() + first);
    std::copy_n(state.v.data() + first, count, work.velocity_before.data() + first);
  });
}

absl::Status Advance(const StepPlan& plan, const v1::Parameters& parameters, double dt, State& state, Workspace& work) {
  const Integrator& integrator = plan.FindIntegrator(parameters);
  if (absl::Status runs = CheckCombination(plan.model(), integrator, parameters); !runs.ok()) {
    return absl::AbortedError(runs.message());
  }
  if (parameters.step_tolerance() > 0 && integrator.order() > 0) {
    return AdvanceAdaptively(plan, parameters, dt, state, work);
  }
  if (integrator.needs_start()) CopyStart(plan, state, work);
  absl::Status advanced = integrator.Advance(plan, parameters, dt, state, work);
  if (plan.follows_coordinates()) plan.DriveMotions(parameters, dt, work.scratch, state);
  if (advanced.ok()) plan.AdvanceScalars(parameters, dt, work.scratch, state);
  return advanced;
}

void AdvanceClock(const v1::Parameters& parameters, double dt, State& state) {
  state.time += dt;
  state.phase += dt / parameters.breath_length();
  ++state.tick;
}

}  // namespace

absl::Status Step(const Model& model, const v1::Parameters& parameters, double dt, State& state, Workspace& work) {
  work.effort.Begin(parameters.solver_budget());
  work.bounds.clear();
  absl::Status advanced = Advance(*model.plan, parameters, dt, state, work);
  AdvanceClock(parameters, dt, state);
  if (!advanced.ok()) return advanced;
  return WithinBounds(model, dt, state, work) ? absl::OkStatus() : absl::OutOfRangeError("the step diverged");
}

}  // namespace phrenic
