// Evaluates skin weights (skin.h), position and velocity in one vector (Google Highway: the machine's best instruction
// set is chosen at run time, and all give the same bits). Thread-safe.
#ifndef PHRENIC_SERVER_MECHANICS_SKINNING_SKIN_KERNEL_H_
#define PHRENIC_SERVER_MECHANICS_SKINNING_SKIN_KERNEL_H_

#include <span>

#include "server/mechanics/skin.h"
#include "server/mechanics/skinning/pose_matrices.h"

namespace phrenic {

// The drivers at one moment. Arrays are 3 x n, point after point.
struct DriverState {
  std::span<const PoseMatrices> poses;
  const double* rest;   // simulated vertices [m]
  const double *x, *v;  // the same now [m], [m/s]
};

// Sets x = rest + the weighted displacements of the drivers [m], and v to their weighted velocities [m/s], for the
// vertices with weights. `rest`, x and v are those of the skinned body; v may be null.
void ApplySkinWeights(std::span<const SkinWeight> weights, const DriverState& drivers, const double* rest, double* x,
                      double* v = nullptr);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SKINNING_SKIN_KERNEL_H_
