#include "server/mechanics/integrators/static_equilibrium.h"

#include <algorithm>
#include <limits>

#include "absl/status/statusor.h"
#include "server/mechanics/solve/implicit_system.h"
#include "server/mechanics/step/advance.h"

namespace phrenic {
namespace {

constexpr int kMostSteps = 300;
constexpr double kStillness = 1e-9;               // of the scene's size: the last step's way
constexpr double kFar = 0.05;                     // of the scene's size: a step is to be no longer
constexpr double kFirst = 1.0 / 60, kLast = 100;  // of the pseudo-time step h [s]
constexpr double kGrowth = 4;
constexpr double kResidual = 1e-4;  // relative residual of the linear system

// One step of pseudo-time h from work.stages[1]; how far the vertex that went furthest has gone [m].
absl::StatusOr<double> Relax(const Model& model, const v1::Parameters& parameters, double dt, double h, State& state,
                             Workspace& work) {
  Points &change = work.stages[0], &start = work.stages[1];
  start = state.x;
  const EvalContext at = EvalContextAhead(model, parameters, dt, state);
  SumForces(model, at, work.force);
  work.force *= h;
  work.system->Assemble(model, at, h);
  change.setZero();
  absl::Status solved = work.system->Solve(model, at, work.force, kResidual, work.effort, change);
  if (!solved.ok()) return solved;
  AddToFree(model, h, change, state.x);
  ProjectPositions(model, parameters, start, h, state);
  state.v.setZero();
  return (state.x - start).cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
}

}  // namespace

double StaticEquilibrium::MaxStep(const Spectrum&) const { return std::numeric_limits<double>::infinity(); }

absl::Status StaticEquilibrium::Advance(const Model& model, const v1::Parameters& parameters, double dt, State& state,
                                        Workspace& work) const {
  state.v.setZero();
  DriveMotions(model, parameters, dt, state);
  if (state.x.cols() == 0) return absl::OkStatus();
  if (work.system == nullptr) work.system = std::make_unique<ImplicitSystem>(model);
  work.stages.resize(std::max<size_t>(work.stages.size(), 2));
  work.stages[0].resize(3, state.x.cols());
  double h = kFirst;
  for (int step = 0; step < kMostSteps; ++step) {
    const absl::StatusOr<double> moved = Relax(model, parameters, dt, h, state, work);
    if (!moved.ok()) return moved.status();
    if (*moved <= kStillness * model.size && h >= kLast) return absl::OkStatus();
    if (work.effort.Spent()) return absl::OkStatus();
    const bool near = *moved <= kFar * model.size;
    if (!near) state.x = work.stages[1];
    h = near ? std::min(kLast, kGrowth * h) : h / kGrowth;
  }
  return absl::AbortedError(
      "no equilibrium was found: hold some vertices, raise elasticity, or use an integrator that moves");
}

}  // namespace phrenic
