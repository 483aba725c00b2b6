#include "server/mechanics/integrators/static_equilibrium.h"

#include <algorithm>
#include <limits>

#include "absl/status/statusor.h"
#include "server/mechanics/solve/implicit_system.h"
#include "server/mechanics/step/step_plan.h"

namespace phrenic {
namespace {

constexpr int kMostSteps = 300;
constexpr double kStillness = 1e-9;               // of the scene's size: displacement of the last step
constexpr double kFar = 0.05;                     // of the scene's size: a longer step is rejected
constexpr double kFirst = 1.0 / 60, kLast = 100;  // of the pseudo-time step h [s]
constexpr double kGrowth = 4;
constexpr double kResidual = 1e-4;  // relative residual of the linear system

// Takes one step of pseudo-time h from work.Stage(1), which it sets. Returns the largest displacement [m].
absl::StatusOr<double> Relax(const StepPlan& plan, const v1::Parameters& parameters, double dt, double h, State& state,
                             Workspace& work) {
  Points &change = work.Stage(0), &start = work.Stage(1);
  start = state.x;
  const EvalContext at = plan.ContextAhead(parameters, dt, state, work.scratch);
  plan.SumForces(at, work.force);
  work.force *= h;
  auto& system = work.scratch.Get<ImplicitSystem>(plan.model());
  system.Assemble(plan.model(), at, h);
  change.setZero();
  absl::Status solved = system.Solve(plan.model(), at, work.force, kResidual, work.effort, change);
  if (!solved.ok()) return solved;
  plan.AddToFree(h, change, state.x);
  plan.ProjectPositions(parameters, start, h, work.scratch, state);
  state.v.setZero();
  return (state.x - start).cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
}

}  // namespace

double StaticEquilibrium::MaxStep(const Spectrum&) const { return std::numeric_limits<double>::infinity(); }

absl::Status StaticEquilibrium::Advance(const StepPlan& plan, const v1::Parameters& parameters, double dt, State& state,
                                        Workspace& work) const {
  state.v.setZero();
  plan.DriveMotions(parameters, dt, work.scratch, state);
  if (state.x.cols() == 0) return absl::OkStatus();
  const double size = plan.model().size;
  double h = kFirst;
  for (int step = 0; step < kMostSteps; ++step) {
    const absl::StatusOr<double> moved = Relax(plan, parameters, dt, h, state, work);
    if (!moved.ok()) return moved.status();
    if (*moved <= kStillness * size && h >= kLast) return absl::OkStatus();
    if (work.effort.Spent()) return absl::OkStatus();
    const bool near = *moved <= kFar * size;
    if (!near) state.x = work.Stage(1);
    h = near ? std::min(kLast, kGrowth * h) : h / kGrowth;
  }
  return absl::AbortedError(
      "no equilibrium was found: hold some vertices, raise elasticity, or use an integrator that moves");
}

}  // namespace phrenic
