// The forces of links at one moment, for integrators that evaluate accelerations.
#ifndef PHRENIC_SERVER_MECHANICS_SOLVE_LINK_FORCES_H_
#define PHRENIC_SERVER_MECHANICS_SOLVE_LINK_FORCES_H_

#include "server/mechanics/step/step_plan.h"

namespace phrenic {

// Adds to `f`, the sum of all other forces [N], the forces along the links that keep their lengths to second order in
// time: the relative acceleration along a link is -|v_b - v_a|^2/length across it. Limits act if they are reached and
// would be violated at the `first` evaluation of a step; later ones release some only. `state` is that `ahead` [s] of
// its time.
void AddLinkForces(const StepPlan& plan, const v1::Parameters& parameters, double ahead, const State& state, bool first,
                   const Scratch& scratch, Points& f);

// Takes from the velocities at the start of a step what would change a link's length, as bones do that start to move.
// Requires: work.velocity_before are those of `state`.
void StartConsistently(const StepPlan& plan, const v1::Parameters& parameters, State& state, Workspace& work);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SOLVE_LINK_FORCES_H_
