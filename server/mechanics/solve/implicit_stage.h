// One implicit stage: what backward Euler, BDF2 and TR-BDF2 have in common.
#ifndef PHRENIC_SERVER_MECHANICS_SOLVE_IMPLICIT_STAGE_H_
#define PHRENIC_SERVER_MECHANICS_SOLVE_IMPLICIT_STAGE_H_

#include "absl/status/status.h"
#include "server/mechanics/model.h"

namespace phrenic {

// Enough for every step that settles at all.
inline constexpr int kNewtonSteps = 40;

// v' = velocity + g f(x', v', t + ahead)/m, x' = position + g v'.
struct ImplicitStage {
  double ahead;            // [s] of the state's own time
  double g;                // [s]
  const Points& position;  // [m]
  const Points& velocity;  // [m/s]
  int newton_steps;        // at most; 1 makes the method linearly implicit
  // What the first Newton step is guessed to be [m/s], at which its linear system starts; null for nothing.
  const Points* guess = nullptr;
};

// x = position + g v for free vertices; driven ones and poses where the motions have them at that time.
void PlaceStage(const Model& model, const v1::Parameters& parameters, const ImplicitStage& stage, State& state);
// g f - m (v - velocity), with `at` the stage's moment: what is missing to the stage's equation [N s].
void StageResidual(const Model& model, const ImplicitStage& stage, const EvalContext& at, Points& residual);

// Solves the stage by Newton's method from the velocities that `state` has, and leaves x' and v' there, driven vertices
// and poses where the motions have them. ABORTED where Newton's method does not settle within its steps (a single
// one is not asked to). Does not allocate once `work` has its system.
absl::Status SolveStage(const Model& model, const v1::Parameters& parameters, const ImplicitStage& stage, State& state,
                        Workspace& work);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SOLVE_IMPLICIT_STAGE_H_
