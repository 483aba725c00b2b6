// The damping of all forces of a model at one moment: -df/dv = diag(c) + S.
#ifndef PHRENIC_SERVER_MECHANICS_DAMPING_H_
#define PHRENIC_SERVER_MECHANICS_DAMPING_H_

#include "server/mechanics/model.h"

namespace phrenic {

// Sets c, one coefficient per simulated vertex [N s/m]. Requires: c has that size.
void SumDamping(const Model& model, const EvalContext& at, Eigen::VectorXd& c);

// Sets `shared` to S [N s/m].
void SumSharedDamping(const Model& model, const EvalContext& at, OuterProducts& shared);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_DAMPING_H_
