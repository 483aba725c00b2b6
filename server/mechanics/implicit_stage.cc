#include "server/mechanics/implicit_stage.h"

#include "server/mechanics/advance.h"
#include "server/mechanics/implicit_system.h"

namespace phrenic {
namespace {

constexpr double kSettled = 1e-7;  // of the scene's size: the last Newton step's way
constexpr double kUsable = 1e-5;   // of the scene's size: what may be left after the last Newton step
constexpr double kLinear = 1e-3;   // relative residual of the linear system: Newton's method mends the rest

// x = position + g v for free vertices; driven ones where they are at that time.
void Place(const Model& model, const v1::Parameters& parameters, const ImplicitStage& stage, State& state) {
  for (Eigen::Index i = 0; i < state.x.cols(); ++i) {
    if (model.inverse_mass[i] > 0) state.x.col(i) = stage.position.col(i) + stage.g * state.v.col(i);
  }
  DriveMotions(model, parameters, stage.ahead, state);
}

// g f - m (v - velocity): what is missing to the stage's equation [N s].
void Residual(const Model& model, const ImplicitStage& stage, const Instant& at, Points& residual) {
  SumForces(model, at, residual);
  residual = stage.g * residual - (at.v - stage.velocity) * model.mass.asDiagonal();
}

}  // namespace

absl::Status SolveStage(const Model& model, const v1::Parameters& parameters, const ImplicitStage& stage, State& state,
                        Workspace& work) {
  if (state.x.cols() == 0) return absl::OkStatus();
  if (work.system == nullptr) work.system = std::make_unique<ImplicitSystem>(model);
  work.stages.resize(std::max<size_t>(work.stages.size(), 1));
  Points& change = work.stages[0];
  change.resize(3, state.x.cols());
  double moved = 0;
  for (int step = 0; step < stage.newton_steps; ++step) {
    Place(model, parameters, stage, state);
    const Instant at = InstantAhead(model, parameters, stage.ahead, state);
    Residual(model, stage, at, work.force);
    work.system->Assemble(model, at, stage.g);
    if (absl::Status solved = work.system->Solve(model, work.force, kLinear, change); !solved.ok()) return solved;
    AddToFree(model, 1, change, state.v);
    moved = stage.g * change.cwiseAbs().maxCoeff();
    if (!(moved > kSettled * model.size)) break;
  }
  Place(model, parameters, stage, state);
  if (stage.newton_steps > 1 && !(moved <= kUsable * model.size)) {
    return absl::AbortedError("Newton's method found no end of the step: lower time_step, or set a step_tolerance");
  }
  return absl::OkStatus();
}

}  // namespace phrenic
