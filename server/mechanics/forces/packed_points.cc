#include "server/mechanics/forces/packed_points.h"

#include "server/mechanics/forces/spring_kernel.h"
#include "server/mechanics/parallel/vertex_range.h"

namespace phrenic {
namespace {

struct PackedPoints {
  AlignedNumbers<float> numbers;
};

}  // namespace

const float* PackAll(const ConstPoints& x, int from, const Scratch& scratch) {
  float* const packed = scratch.Get<PackedPoints>().numbers.Fit(kPointStride<float> * x.cols());
  ForEachBlock({0, x.cols()},
               [&](const VertexRange& block) { PackPoints(block, x.data(), x.col(from).data(), packed); });
  return packed;
}

}  // namespace phrenic
