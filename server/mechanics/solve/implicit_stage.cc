#include "server/mechanics/solve/implicit_stage.h"

#include <algorithm>

#include "server/mechanics/solve/implicit_system.h"

namespace phrenic {
namespace {

constexpr double kStageSettled = 1e-7;   // of the scene's size: displacement of the last Newton step
constexpr double kUsable = 1e-5;         // of the scene's size: the largest such displacement that is good enough
constexpr double kStageResidual = 1e-3;  // relative residual of the linear system: Newton's method corrects the rest
constexpr double kOvershot = 0.9;  // of the residual along a step: if its reverse is larger at the end, it overshot
constexpr double kLeastFraction = 0.1;
constexpr int kShortenings = 6;

// A step of Newton's method [m/s], 3 x n. The stiffness leaves out negative terms, so that a step leads downhill; if it
// overshoots the minimum by far it is shortened, by the secant of the residual along it.
struct NewtonStep {
  Points& change;
  double along = 0;  // the residual along it at its start
  int shortened = 0;

  double Along(const Points& residual) const { return residual.cwiseProduct(change).sum(); }
  void Begin(const Points& residual) {
    along = Along(residual);
    shortened = 0;
  }
  bool Overshot(const Points& residual) const {
    return shortened < kShortenings && Along(residual) < -kOvershot * along;
  }
  // Shortens it to a fraction of itself. Returns the fraction.
  double Shorten(const Points& residual) {
    const double fraction = std::max(kLeastFraction, along / (along - Along(residual)));
    change *= fraction;
    along *= fraction;
    ++shortened;
    return fraction;
  }
};

}  // namespace

void PlaceStage(const StepPlan& plan, const v1::Parameters& parameters, const ImplicitStage& stage,
                const Scratch& scratch, State& state) {
  for (Eigen::Index i = 0; i < state.x.cols(); ++i) {
    if (plan.model().inverse_mass[i] > 0) state.x.col(i) = stage.position.col(i) + stage.g * state.v.col(i);
  }
  plan.DriveMotions(parameters, stage.ahead, scratch, state);
}

void StageResidual(const StepPlan& plan, const ImplicitStage& stage, const EvalContext& at, Points& residual) {
  plan.SumForces(at, residual);
  residual = stage.g * residual - (at.v - stage.velocity) * plan.model().mass.asDiagonal();
}

absl::Status SolveStage(const StepPlan& plan, const v1::Parameters& parameters, const ImplicitStage& stage,
                        State& state, Workspace& work) {
  if (state.x.cols() == 0) {
    plan.DriveMotions(parameters, stage.ahead, work.scratch, state);
    return absl::OkStatus();
  }
  const Model& model = plan.model();
  auto& system = work.scratch.Get<ImplicitSystem>(model);
  NewtonStep last{.change = work.Stage(0)};
  last.change.setZero();
  const auto displacement = [&] { return stage.g * last.change.cwiseAbs().maxCoeff(); };
  for (int step = 0; step < stage.newton_steps; ++step) {
    PlaceStage(plan, parameters, stage, work.scratch, state);
    const EvalContext at = plan.ContextAhead(parameters, stage.ahead, state, work.scratch);
    StageResidual(plan, stage, at, work.force);
    if (last.Overshot(work.force)) {
      const double fraction = last.Shorten(work.force);
      plan.AddToFree(1 - 1 / fraction, last.change, state.v);
      continue;
    }
    system.Assemble(model, at, stage.g);
    if (step == 0 && stage.guess != nullptr) {
      last.change = *stage.guess;
    } else {
      last.change.setZero();
    }
    absl::Status solved = system.Solve(model, at, work.force, kStageResidual, work.effort, last.change);
    if (!solved.ok()) return solved;
    last.Begin(work.force);
    plan.AddToFree(1, last.change, state.v);
    if (!(displacement() > kStageSettled * model.size) || work.effort.Spent()) break;
  }
  PlaceStage(plan, parameters, stage, work.scratch, state);
  const bool usable = last.shortened == 0 && displacement() <= kUsable * model.size;
  if (stage.newton_steps > 1 && !usable && !work.effort.Spent()) {
    return absl::AbortedError("Newton's method found no end of the step: lower time_step, or set a step_tolerance");
  }
  return absl::OkStatus();
}

}  // namespace phrenic
