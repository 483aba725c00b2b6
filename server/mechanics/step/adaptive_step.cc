#include "server/mechanics/step/adaptive_step.h"

#include <algorithm>
#include <cmath>

namespace phrenic {
namespace {

constexpr int kMostHalvings = 12;

// One part of the step: state.time, phase and tick go with it, so that what follows sees its own start. The tick only
// tells an integrator's history whose it is.
absl::Status Part(const Model& model, const v1::Parameters& parameters, const Integrator& integrator, double h,
                  State& state, Workspace& work) {
  work.before = state.x;
  work.velocity_before = state.v;
  if (absl::Status status = integrator.Advance(model, parameters, h, state, work); !status.ok()) return status;
  state.time += h;
  state.phase += h / parameters.breath_length();
  ++state.tick;
  return absl::OkStatus();
}

// Takes `from` over h in two halves into `halves`; how much that differs from one step [m], infinity where one failed.
// Velocities count by how far they carry in h: a vibration too fast for h feeds on itself before positions show it.
double Compare(const Model& model, const v1::Parameters& parameters, const Integrator& integrator, double h,
               const State& from, State& whole, State& halves, Workspace& work) {
  whole = halves = from;
  if (!Part(model, parameters, integrator, h, whole, work).ok()) return HUGE_VAL;
  for (int half = 0; half < 2; ++half) {
    if (!Part(model, parameters, integrator, h / 2, halves, work).ok()) return HUGE_VAL;
  }
  const double x = (whole.x - halves.x).colwise().squaredNorm().maxCoeff<Eigen::PropagateNaN>();
  const double v = (whole.v - halves.v).colwise().squaredNorm().maxCoeff<Eigen::PropagateNaN>();
  return std::isfinite(x) && std::isfinite(v) ? std::sqrt(std::max(x, h * h * v)) : HUGE_VAL;
}

}  // namespace

absl::Status AdvanceAdaptively(const Model& model, const v1::Parameters& parameters, const Integrator& integrator,
                               double dt, State& state, Workspace& work) {
  work.trials.resize(3);
  State &from = work.trials[0], &whole = work.trials[1], &halves = work.trials[2];
  from = state;
  const double allowed = parameters.step_tolerance() * std::max(1.0, std::exp2(integrator.order()) - 1);
  int halvings = std::max(0, state.halvings - 1);
  for (int done = 0; done < 1 << halvings;) {
    const double h = std::ldexp(dt, -halvings);
    const double difference = Compare(model, parameters, integrator, h, from, whole, halves, work);
    if (difference <= allowed) {
      std::swap(from, halves);
      ++done;
    } else if (halvings == kMostHalvings) {
      return absl::AbortedError("no part of the step is small enough for step_tolerance: raise it, or lower time_step");
    } else {
      ++halvings;
      done *= 2;
    }
  }
  from.history.tick = from.history.tick == from.tick ? state.tick + 1 : -1;
  from.time = state.time;
  from.phase = state.phase;
  from.tick = state.tick;
  from.halvings = halvings;
  std::swap(state, from);
  return absl::OkStatus();
}

}  // namespace phrenic
