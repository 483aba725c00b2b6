// Poses as matrices: computed once per pose for all points that follow it.
#ifndef PHRENIC_SERVER_MECHANICS_SKINNING_POSE_MATRICES_H_
#define PHRENIC_SERVER_MECHANICS_SKINNING_POSE_MATRICES_H_

#include <span>

#include "server/mechanics/eval_context.h"

namespace phrenic {

// The displacement of a point X at rest, (R - 1) X + t, and its velocity (w x R) X + v. Three columns are those of the
// matrices, the fourth is what is added; the first half of a column is of the displacement [m], the second of the
// velocity [m/s].
struct alignas(64) PoseMatrices {
  explicit PoseMatrices(const Pose& pose);
  double column[4][8];
};

// Returns one per pose: those of the context if it has them, otherwise in its scratch memory until the next call.
std::span<const PoseMatrices> PoseMatricesOf(const EvalContext& at);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SKINNING_POSE_MATRICES_H_
