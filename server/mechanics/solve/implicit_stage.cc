#include "server/mechanics/solve/implicit_stage.h"

#include <algorithm>

#include "server/mechanics/solve/implicit_system.h"
#include "server/mechanics/step/advance.h"

namespace phrenic {
namespace {

constexpr double kStageSettled = 1e-7;   // of the scene's size: the last Newton step's way
constexpr double kUsable = 1e-5;         // of the scene's size: what may be left after the last Newton step
constexpr double kStageResidual = 1e-3;  // relative residual of the linear system: Newton's method mends the rest
constexpr double kOvershot = 0.9;  // of the residual along a step, with the other sign at its end: it went too far
constexpr double kLeastPart = 0.1;
constexpr int kShortenings = 6;

// A step of Newton's method, [m/s] at each vertex. The stiffness leaves out what is negative in it, so that a step goes
// downhill; where it goes far beyond the bottom it is shortened, by the secant of the residual along it.
struct NewtonStep {
  Points& change;
  double along = 0;  // the residual along it where it began
  int shortened = 0;

  double Along(const Points& residual) const { return residual.cwiseProduct(change).sum(); }
  void Begin(const Points& residual) {
    along = Along(residual);
    shortened = 0;
  }
  bool Overshot(const Points& residual) const {
    return shortened < kShortenings && Along(residual) < -kOvershot * along;
  }
  // Makes it the part of itself that it returns.
  double Shorten(const Points& residual) {
    const double part = std::max(kLeastPart, along / (along - Along(residual)));
    change *= part;
    along *= part;
    ++shortened;
    return part;
  }
};

}  // namespace

void PlaceStage(const Model& model, const v1::Parameters& parameters, const ImplicitStage& stage, State& state) {
  for (Eigen::Index i = 0; i < state.x.cols(); ++i) {
    if (model.inverse_mass[i] > 0) state.x.col(i) = stage.position.col(i) + stage.g * state.v.col(i);
  }
  DriveMotions(model, parameters, stage.ahead, state);
}

void StageResidual(const Model& model, const ImplicitStage& stage, const EvalContext& at, Points& residual) {
  SumForces(model, at, residual);
  residual = stage.g * residual - (at.v - stage.velocity) * model.mass.asDiagonal();
}

absl::Status SolveStage(const Model& model, const v1::Parameters& parameters, const ImplicitStage& stage, State& state,
                        Workspace& work) {
  if (state.x.cols() == 0) {
    DriveMotions(model, parameters, stage.ahead, state);
    return absl::OkStatus();
  }
  if (work.system == nullptr) work.system = std::make_unique<ImplicitSystem>(model);
  work.stages.resize(std::max<size_t>(work.stages.size(), 1));
  NewtonStep last{.change = work.stages[0]};
  last.change.setZero(3, state.x.cols());
  const auto moved = [&] { return stage.g * last.change.cwiseAbs().maxCoeff(); };
  for (int step = 0; step < stage.newton_steps; ++step) {
    PlaceStage(model, parameters, stage, state);
    const EvalContext at = EvalContextAhead(model, parameters, stage.ahead, state);
    StageResidual(model, stage, at, work.force);
    if (last.Overshot(work.force)) {
      const double part = last.Shorten(work.force);
      AddToFree(model, 1 - 1 / part, last.change, state.v);
      continue;
    }
    work.system->Assemble(model, at, stage.g);
    if (step == 0 && stage.guess != nullptr) {
      last.change = *stage.guess;
    } else {
      last.change.setZero();
    }
    absl::Status solved = work.system->Solve(model, at, work.force, kStageResidual, work.effort, last.change);
    if (!solved.ok()) return solved;
    last.Begin(work.force);
    AddToFree(model, 1, last.change, state.v);
    if (!(moved() > kStageSettled * model.size) || work.effort.Spent()) break;
  }
  PlaceStage(model, parameters, stage, state);
  const bool usable = last.shortened == 0 && moved() <= kUsable * model.size;
  if (stage.newton_steps > 1 && !usable && !work.effort.Spent()) {
    return absl::AbortedError("Newton's method found no end of the step: lower time_step, or set a step_tolerance");
  }
  return absl::OkStatus();
}

}  // namespace phrenic
