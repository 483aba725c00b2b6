// The forces of links at one moment, for integrators that evaluate accelerations.
#ifndef PHRENIC_SERVER_MECHANICS_SOLVE_LINK_FORCES_H_
#define PHRENIC_SERVER_MECHANICS_SOLVE_LINK_FORCES_H_

#include "server/mechanics/step/step_plan.h"

namespace phrenic {

// Adds to `f`, the sum of all other forces [N], the forces along the links that keep their lengths to second order in
// time: the relative acceleration along a link is -|v_b - v_a|^2/length across it. Limits act if they are reached and
// would be violated. `state` is that `ahead` [s] of its time.
void AddLinkForces(const StepPlan& plan, const v1::Parameters& parameters, double ahead, const State& state,
                   const Scratch& scratch, Points& f);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SOLVE_LINK_FORCES_H_
