#include "server/mechanics/integrators/tr_bdf2.h"

#include <limits>
#include <numbers>

#include "server/mechanics/solve/implicit_stage.h"
#include "server/mechanics/solve/link_forces.h"
#include "server/mechanics/step/step_plan.h"

namespace phrenic {
namespace {

constexpr double kGamma = 2 - std::numbers::sqrt2;
constexpr double kWeight = kGamma / 2;  // of dt in g, the same in both stages
// The second stage's own weights of the middle and of the start.
constexpr double kMiddle = 1 / (kGamma * (2 - kGamma));
constexpr double kStart = 1 - kMiddle;

}  // namespace

double TrBdf2::MaxStep(const Spectrum&) const { return std::numeric_limits<double>::infinity(); }

absl::Status TrBdf2::Advance(const StepPlan& plan, const v1::Parameters& parameters, double dt, State& state,
                             Workspace& work) const {
  StartConsistently(plan, parameters, state, work);
  Points &position = work.Stage(1), &velocity = work.Stage(2);
  const double g = kWeight * dt;
  plan.SumForces(plan.ContextAhead(parameters, 0, state, work.scratch), work.force);
  AddLinkForces(plan, parameters, 0, state, true, work.scratch, work.force);
  position = work.before + g * work.velocity_before;
  velocity = work.velocity_before + g * work.force * plan.model().inverse_mass.asDiagonal();
  const ImplicitStage trapezoid{kGamma * dt, g, position, velocity, kNewtonSteps};
  if (absl::Status solved = SolveStage(plan, parameters, trapezoid, state, work); !solved.ok()) return solved;
  ProjectStage(plan, parameters, trapezoid, work.before, work, state);
  position = kMiddle * state.x + kStart * work.before;
  velocity = kMiddle * state.v + kStart * work.velocity_before;
  const ImplicitStage bdf2{dt, g, position, velocity, kNewtonSteps};
  if (absl::Status solved = SolveStage(plan, parameters, bdf2, state, work); !solved.ok()) return solved;
  ProjectStage(plan, parameters, bdf2, work.before, work, state);
  return absl::OkStatus();
}

}  // namespace phrenic
