// Poses as matrices, computed once per pose for all points that follow it.
#ifndef PHRENIC_SERVER_MECHANICS_SKINNING_POSE_MATRICES_H_
#define PHRENIC_SERVER_MECHANICS_SKINNING_POSE_MATRICES_H_

#include <span>

#include "server/mechanics/eval_context.h"

namespace phrenic {

// The affine maps from a rest position X [m] to its displacement (R - 1) X + t [m] and its velocity (w x R) X + v
// [m/s]. Columns 0 to 2 are those of the matrices, column 3 the constant term. Rows 0 to 2 are the displacement, rows 4
// to 6 the velocity; rows 3 and 7 are padding.
struct alignas(64) PoseMatrices {
  explicit PoseMatrices(const Pose& pose);
  double column[4][8];
};

// Returns one per pose: those of the context if it has them; otherwise computes them in its scratch memory, valid until
// the next call.
std::span<const PoseMatrices> PoseMatricesOf(const EvalContext& at);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SKINNING_POSE_MATRICES_H_
