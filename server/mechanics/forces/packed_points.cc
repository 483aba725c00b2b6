#include "server/mechanics/forces/packed_points.h"

#include "server/mechanics/forces/spring_kernel.h"
#include "server/mechanics/parallel/vertex_range.h"

namespace phrenic {

const float* PackAll(const ConstPoints& x, int from) {
  float* const packed = ThreadMemory<Kept::kForAll, float>(kPointStride<float> * x.cols());
  ForEachBlock({0, x.cols()},
               [&](const VertexRange& block) { PackPoints(block, x.data(), x.col(from).data(), packed); });
  return packed;
}

}  // namespace phrenic
