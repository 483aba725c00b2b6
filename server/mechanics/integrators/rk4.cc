#include "server/mechanics/integrators/rk4.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "server/mechanics/step/advance.h"

namespace phrenic {
namespace {

// Of the stability region: how far it reaches along the negative real axis, less than along any other direction.
constexpr double kRadius = 2.785;

struct Stage {
  double at;      // the part of the step after which its slopes are taken
  double weight;  // of its slopes in the whole
};
constexpr std::array<Stage, 4> kStages = {{{0, 1.0 / 6}, {0.5, 1.0 / 3}, {0.5, 1.0 / 3}, {1, 1.0 / 6}}};

// state = start + h slope, with driven vertices and poses where they are then.
void MoveBy(const Model& model, const v1::Parameters& parameters, double h, const Points& velocity,
            const Points& acceleration, const Workspace& work, State& state) {
  state.x = work.before;
  state.v = work.velocity_before;
  AddToFree(model, h, velocity, state.x);
  AddToFree(model, h, acceleration, state.v);
  DriveMotions(model, parameters, h, state);
}

}  // namespace

double Rk4::MaxStep(const Spectrum& spectrum) const {
  const double half = spectrum.damping_rate / 2, omega = spectrum.omega_max;
  const double fastest = half <= omega ? omega : half + std::sqrt(half * half - omega * omega);
  return fastest > 0 ? kRadius / fastest : std::numeric_limits<double>::infinity();
}

absl::Status Rk4::Advance(const Model& model, const v1::Parameters& parameters, double dt, State& state,
                          Workspace& work) const {
  work.stages.resize(std::max<size_t>(work.stages.size(), 4));
  Points &velocity = work.stages[0], &acceleration = work.stages[1];     // of the stage
  Points &velocities = work.stages[2], &accelerations = work.stages[3];  // their weighted sums
  velocities.setZero(3, state.x.cols());
  accelerations.setZero(3, state.x.cols());
  for (const Stage& stage : kStages) {
    if (stage.at > 0) MoveBy(model, parameters, stage.at * dt, velocity, acceleration, work, state);
    SumForces(model, EvalContextAhead(model, parameters, stage.at * dt, state), work.force);
    velocity = state.v;
    acceleration = work.force * model.inverse_mass.asDiagonal();
    velocities += stage.weight * velocity;
    accelerations += stage.weight * acceleration;
  }
  MoveBy(model, parameters, dt, velocities, accelerations, work, state);
  ProjectPositions(model, parameters, work.before, dt, state);
  ProjectVelocities(model, parameters, state);
  return absl::OkStatus();
}

}  // namespace phrenic
