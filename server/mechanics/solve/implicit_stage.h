// One stage of an implicit integrator: v' = velocity + (g f(x', v', t + ahead) + E m)/m, x' = position + g v', with the
// impulses E m of links such that x' has their lengths (LinkEquations). Backward Euler, BDF2 and TR-BDF2 are made of
// such stages. ProjectStage then takes from v' what would change a length: together that is the index-2 form of the
// equations with links (Gear, Gupta, Leimkuhler, J Comput Appl Math 1985;12:77), for which these methods keep their
// order.
#ifndef PHRENIC_SERVER_MECHANICS_SOLVE_IMPLICIT_STAGE_H_
#define PHRENIC_SERVER_MECHANICS_SOLVE_IMPLICIT_STAGE_H_

#include "absl/status/status.h"
#include "server/mechanics/solve/link_equations.h"
#include "server/mechanics/step/step_plan.h"

namespace phrenic {

// Newton steps that are enough for every stage that converges.
inline constexpr int kNewtonSteps = 40;

struct ImplicitStage {
  double ahead;            // time of the stage, from the state's own [s]
  double g;                // [s]
  const Points& position;  // 3 x n [m]
  const Points& velocity;  // 3 x n [m/s]
  int newton_steps;        // at most; 1 makes the method linearly implicit
  // First guess of the first Newton step [m/s], where its linear system starts; null for 0.
  const Points* guess = nullptr;
};

// Sets x = position + g v for free vertices, and driven vertices and poses to where the motions have them at that time.
void PlaceStage(const StepPlan& plan, const v1::Parameters& parameters, const ImplicitStage& stage,
                const Scratch& scratch, State& state);

// Sets `residual` to g f - m (v - velocity), the residual of the stage's equation [N s], 3 x n. `at` is its moment.
void StageResidual(const StepPlan& plan, const ImplicitStage& stage, const EvalContext& at, Points& residual);

// Solves the stage by Newton's method from the velocities of `state`. Leaves x' and v' there, and driven vertices and
// poses where the motions have them. ABORTED if Newton's method does not converge within its steps; a single step need
// not converge. Allocates in its first call with this `work` only.
absl::Status SolveStage(const StepPlan& plan, const v1::Parameters& parameters, const ImplicitStage& stage,
                        State& state, Workspace& work);

// Removes from the stage's end what Newton's method has left of gaps, and the velocities along links. `before` are the
// positions at the start of the step [m].
void ProjectStage(const StepPlan& plan, const v1::Parameters& parameters, const ImplicitStage& stage,
                  const Points& before, Workspace& work, State& state);

// Returns the links that a step solves together with the forces; null if there are none or they are switched off.
LinkEquations* ActingLinks(const StepPlan& plan, const v1::Parameters& parameters, const Scratch& scratch);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SOLVE_IMPLICIT_STAGE_H_
