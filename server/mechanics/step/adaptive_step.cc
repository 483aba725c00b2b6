#include "server/mechanics/step/adaptive_step.h"

#include <algorithm>
#include <cmath>

namespace phrenic {
namespace {

constexpr int kMostHalvings = 12;

// Advances `state` by one part, with time, phase and tick, so that the next part begins where this one ends. The tick
// tells an integrator whether State::history belongs to the state.
absl::Status AdvancePart(const StepPlan& plan, const v1::Parameters& parameters, double h, State& state,
                         Workspace& work) {
  work.before = state.x;
  work.velocity_before = state.v;
  absl::Status status = plan.FindIntegrator(parameters).Advance(plan, parameters, h, state, work);
  if (!status.ok()) return status;
  if (plan.follows_coordinates()) plan.DriveMotions(parameters, h, work.scratch, state);
  plan.AdvanceScalars(parameters, h, work.scratch, state);
  state.time += h;
  state.phase += h / parameters.breath_length();
  ++state.tick;
  return absl::OkStatus();
}

// Advances `from` over h as one part into `whole` and as two into `halves`. Returns the difference [m]; infinity if a
// part failed. Velocities count by the distance they cover in h: a vibration too fast for h grows before positions
// show it.
double Compare(const StepPlan& plan, const v1::Parameters& parameters, double h, const State& from, State& whole,
               State& halves, Workspace& work) {
  whole = halves = from;
  if (!AdvancePart(plan, parameters, h, whole, work).ok()) return HUGE_VAL;
  for (int half = 0; half < 2; ++half) {
    if (!AdvancePart(plan, parameters, h / 2, halves, work).ok()) return HUGE_VAL;
  }
  const double x = (whole.x - halves.x).colwise().squaredNorm().maxCoeff<Eigen::PropagateNaN>();
  const double v = (whole.v - halves.v).colwise().squaredNorm().maxCoeff<Eigen::PropagateNaN>();
  return std::isfinite(x) && std::isfinite(v) ? std::sqrt(std::max(x, h * h * v)) : HUGE_VAL;
}

// Makes `end` the state, with the time, phase and tick of the start of the step.
void TakeParts(int halvings, State& end, State& state) {
  end.history.tick = end.history.tick == end.tick ? state.tick + 1 : -1;
  end.time = state.time;
  end.phase = state.phase;
  end.tick = state.tick;
  end.halvings = halvings;
  std::swap(state, end);
}

}  // namespace

absl::Status AdvanceAdaptively(const StepPlan& plan, const v1::Parameters& parameters, double dt, State& state,
                               Workspace& work) {
  work.trials.resize(3);
  State &from = work.trials[0], &whole = work.trials[1], &halves = work.trials[2];
  from = state;
  const int order = plan.FindIntegrator(parameters).order();
  const double allowed = parameters.step_tolerance() * std::max(1.0, std::exp2(order) - 1);
  int halvings = std::max(0, state.halvings - 1);
  for (int done = 0; done < 1 << halvings;) {
    const double difference = Compare(plan, parameters, std::ldexp(dt, -halvings), from, whole, halves, work);
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
  TakeParts(halvings, from, state);
  work.bounds.clear();  // those of a part or a trial
  return absl::OkStatus();
}

}  // namespace phrenic
