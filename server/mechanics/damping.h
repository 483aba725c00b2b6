// The damping of all forces of a model at one moment: -df/dv = diag(c) + S + C, C in 3 x 3 blocks (viscosity).
#ifndef PHRENIC_SERVER_MECHANICS_DAMPING_H_
#define PHRENIC_SERVER_MECHANICS_DAMPING_H_

#include "server/mechanics/model.h"

namespace phrenic {

// Sets c, one coefficient per simulated vertex [N s/m]. Requires: c has that size.
void SumDamping(const Model& model, const EvalContext& at, Eigen::VectorXd& c);

// Sets `shared` to S [N s/m].
void SumSharedDamping(const Model& model, const EvalContext& at, OuterProducts& shared);

// True if a force of the model has viscosity.
bool HasViscosity(const Model& model);

// Adds weight C of one force to `sink`, with `weight` [1/s] as stiffness [N/m].
void AddViscosity(const Force& force, const EvalContext& at, double weight, StiffnessSink& sink);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_DAMPING_H_
