// How far simulated vertices are from where they rest, for skins that follow them.
#ifndef PHRENIC_SERVER_MECHANICS_SKINNING_DISPLACEMENTS_H_
#define PHRENIC_SERVER_MECHANICS_SKINNING_DISPLACEMENTS_H_

#include <vector>

#include "server/mechanics/eval_context.h"

namespace phrenic {

struct alignas(32) Displacement {
  double by[4] = {};  // x, y, z, 0 [m]
};

// Sets one per simulated vertex, at x and `rest`, 3 x n [m].
void SetDisplacements(const ConstPoints& x, const double* rest, std::vector<Displacement>& displacements);

// Returns one per simulated vertex: those of the context if it has them; otherwise computes them in its scratch memory,
// valid until the next call.
const Displacement* DisplacementsOf(const EvalContext& at, const double* rest);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SKINNING_DISPLACEMENTS_H_
