// What a pose does to points, as matrices: made once, for all that it carries.
#ifndef PHRENIC_SERVER_MECHANICS_SKINNING_POSE_MATRICES_H_
#define PHRENIC_SERVER_MECHANICS_SKINNING_POSE_MATRICES_H_

#include <span>
#include <vector>

#include "server/mechanics/eval_context.h"

namespace phrenic {

// What a pose does to a point X of its rest, (R - 1) X + t and its rate (w x R) X + v: column by column of the
// matrices, and of what is added, the displacement [m] in the first half and the velocity [m/s] in the second.
struct alignas(64) PoseMatrices {
  explicit PoseMatrices(const Pose& pose);
  double column[4][8];
};

// One of each pose, in `memory`, which keeps its capacity.
std::span<const PoseMatrices> MakePoseMatrices(const std::vector<Pose>& poses, std::vector<PoseMatrices>& memory);

// Those that a step has made, or else in memory of the thread's own until its next call.
std::span<const PoseMatrices> PoseMatricesOf(const EvalContext& at);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SKINNING_POSE_MATRICES_H_
