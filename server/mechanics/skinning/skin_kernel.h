// SIMD kernel of skin weights (skin.h), with position and velocity in one vector. Google Highway compiles it for
// several instruction sets and selects the best one at run time; the results are bitwise equal on all of them.
// Thread-safe.
#ifndef PHRENIC_SERVER_MECHANICS_SKINNING_SKIN_KERNEL_H_
#define PHRENIC_SERVER_MECHANICS_SKINNING_SKIN_KERNEL_H_

#include <span>

#include "server/mechanics/skin.h"
#include "server/mechanics/skinning/displacements.h"
#include "server/mechanics/skinning/pose_matrices.h"

namespace phrenic {

// The drivers at one moment.
struct DriverState {
  std::span<const PoseMatrices> poses;
  const Displacement* displacements;  // of simulated vertices
  const double* v;                    // their velocities, 3 x n, column-major [m/s]
};

// Sets x = rest + the weighted displacements of the drivers [m], and v to their weighted velocities [m/s], for the
// vertices with weights. `rest`, x and v are those of the skinned body; v may be null.
void ApplySkinWeights(const SkinWeights& weights, const DriverState& drivers, const double* rest, double* x,
                      double* v = nullptr);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SKINNING_SKIN_KERNEL_H_
