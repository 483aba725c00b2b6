#include "server/mechanics/integrators/rk4.h"

#include <array>
#include <cmath>
#include <limits>

#include "server/mechanics/solve/link_forces.h"
#include "server/mechanics/step/step_plan.h"

namespace phrenic {
namespace {

// The extent of the stability region along the negative real axis; it is larger in all other directions.
constexpr double kRadius = 2.785;

struct Stage {
  double at;      // its time, as a fraction of the step
  double weight;  // of its slopes in their sum
};
constexpr std::array<Stage, 4> kStages = {{{0, 1.0 / 6}, {0.5, 1.0 / 3}, {0.5, 1.0 / 3}, {1, 1.0 / 6}}};

// Sets state = start + h slope, with driven vertices and poses at that time.
void MoveBy(const StepPlan& plan, const v1::Parameters& parameters, double h, const Points& velocity,
            const Points& acceleration, const Workspace& work, State& state) {
  state.x = work.before;
  state.v = work.velocity_before;
  plan.AddToFree(h, velocity, state.x);
  plan.AddToFree(h, acceleration, state.v);
  plan.DriveMotions(parameters, h, work.scratch, state);
}

}  // namespace

double Rk4::MaxStep(const Spectrum& spectrum) const {
  const double half = spectrum.damping_rate / 2, omega = spectrum.omega_max;
  const double fastest = half <= omega ? omega : half + std::sqrt(half * half - omega * omega);
  return fastest > 0 ? kRadius / fastest : std::numeric_limits<double>::infinity();
}

absl::Status Rk4::Advance(const StepPlan& plan, const v1::Parameters& parameters, double dt, State& state,
                          Workspace& work) const {
  Points &velocity = work.Stage(0), &acceleration = work.Stage(1);     // of the stage
  Points &velocities = work.Stage(2), &accelerations = work.Stage(3);  // their weighted sums
  StartConsistently(plan, parameters, state, work);
  velocities.setZero();
  accelerations.setZero();
  for (const Stage& stage : kStages) {
    if (stage.at > 0) MoveBy(plan, parameters, stage.at * dt, velocity, acceleration, work, state);
    plan.SumForces(plan.ContextAhead(parameters, stage.at * dt, state, work.scratch), work.force);
    AddLinkForces(plan, parameters, stage.at * dt, state, stage.at == 0, work.scratch, work.force);
    velocity = state.v;
    acceleration = work.force * plan.model().inverse_mass.asDiagonal();
    velocities += stage.weight * velocity;
    accelerations += stage.weight * acceleration;
  }
  MoveBy(plan, parameters, dt, velocities, accelerations, work, state);
  plan.ProjectPositions(parameters, work.before, dt, work.scratch, state);
  plan.ProjectVelocities(parameters, work.scratch, state);
  return absl::OkStatus();
}

}  // namespace phrenic
