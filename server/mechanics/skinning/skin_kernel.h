// Where carriers (skin.h) take a body's vertices, position and velocity in one vector: written once with Google
// Highway, the machine's best instruction set chosen at run time, with the same bits on all of them.
#ifndef PHRENIC_SERVER_MECHANICS_SKINNING_SKIN_KERNEL_H_
#define PHRENIC_SERVER_MECHANICS_SKINNING_SKIN_KERNEL_H_

#include <span>

#include "server/mechanics/skin.h"
#include "server/mechanics/skinning/pose_matrices.h"

namespace phrenic {

// What shares are of. Arrays are 3 x n, point after point.
struct DriverState {
  std::span<const PoseMatrices> poses;
  const double* rest;   // simulated vertices [m]
  const double *x, *v;  // the same now [m], [m/s]
};

// x = rest + sum of what each of the vertex' shares gives, and v the sum of their velocities; of vertices that have
// shares alone. `rest`, x [m] and v [m/s] are those of the riding body. Without v, positions alone.
void ApplySkinWeights(std::span<const SkinWeight> shares, const DriverState& carriers, const double* rest, double* x,
                      double* v = nullptr);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SKINNING_SKIN_KERNEL_H_
