#include "server/mechanics/integrators/static_equilibrium.h"

#include <algorithm>
#include <limits>

#include "absl/status/statusor.h"
#include "server/mechanics/solve/implicit_stage.h"
#include "server/mechanics/solve/linked_system.h"
#include "server/mechanics/step/step_plan.h"

namespace phrenic {
namespace {

constexpr int kMostSteps = 1000;
constexpr double kStillness = 1e-9;               // of the scene's size: displacement of the last step
constexpr double kFar = 0.05;                     // of the scene's size: a longer step is rejected
constexpr double kFirst = 1.0 / 60, kLast = 100;  // of the pseudo-time step h [s]
constexpr double kGrowth = 4;
constexpr double kResidual = 1e-4;  // relative residual of the linear system

// Takes one step of pseudo-time h from work.Stage(1), which it sets. Returns the largest displacement [m].
absl::StatusOr<double> Relax(const StepPlan& plan, const v1::Parameters& parameters, double dt, double h, State& state,
                             Workspace& work) {
  const Model& model = plan.model();
  LinkEquations* const links = ActingLinks(plan, parameters, work.scratch);
  Points &change = work.Stage(0), &start = work.Stage(1);
  start = state.x;
  const EvalContext at = plan.ContextAhead(parameters, dt, state, work.scratch);
  plan.SumForces(at, work.force);
  work.force *= h;
  auto& system = work.scratch.Get<ImplicitSystem>(model);
  system.Assemble(model, at, h);
  change.setZero();
  if (links == nullptr) {
    absl::Status solved = system.Solve(model, at, work.force, kResidual, work.effort, change);
    if (!solved.ok()) return solved;
    plan.AddToFree(h, change, state.x);
    plan.ProjectPositions(parameters, start, h, work.scratch, state);
  } else {
    links->Place(state.x);
    links->AddImpulses(links->multipliers, work.force);
    links->SetTension(h);
    links->ClosingRates(h, links->wanted);
    auto& linked = work.scratch.Get<LinkedSystem>(model);
    absl::Status solved = linked.Solve(model, at, system, *links, work.force, kResidual, work.effort, change);
    if (!solved.ok()) return solved;
    links->multipliers += links->change;
    plan.AddToFree(h, change, state.x);
  }
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
  LinkEquations* const links = ActingLinks(plan, parameters, work.scratch);
  if (links != nullptr && !links->complete()) return absl::AbortedError("the links share too many vertices");
  if (links != nullptr) links->Restart();
  const auto equilibrium = [&] {
    if (links != nullptr) plan.ProjectPositions(parameters, work.Stage(1), h, work.scratch, state);
    state.v.setZero();
    return absl::OkStatus();
  };
  for (int step = 0; step < kMostSteps; ++step) {
    const absl::StatusOr<double> moved = Relax(plan, parameters, dt, h, state, work);
    if (!moved.ok()) return moved.status();
    if ((*moved <= kStillness * size && h >= kLast) || work.effort.Spent()) return equilibrium();
    const bool near = *moved <= kFar * size;
    if (!near) state.x = work.Stage(1);
    const double next = near ? std::min(kLast, kGrowth * h) : h / kGrowth;
    if (links != nullptr) links->multipliers *= next / h;  // the forces stay
    h = next;
  }
  return absl::AbortedError(
      "no equilibrium was found: hold some vertices, raise elasticity, or use an integrator that moves");
}

}  // namespace phrenic
