#include "server/mechanics/forces/shared_force.h"

#include "server/mechanics/linalg/vertex_kernel.h"

namespace phrenic {

void SharedForce::SetWeights(Eigen::VectorXd weights) {
  weights_ = std::move(weights);
  acts_.assign(static_cast<size_t>((weights_.size() + kVertexBlock - 1) / kVertexBlock), false);
  for (Eigen::Index i = 0; i < weights_.size(); ++i) {
    if (weights_[i] != 0) acts_[static_cast<size_t>(i / kVertexBlock)] = true;
  }
}

void SharedForce::AddForceToBlock(const VertexRange& range, const BlockContext& at, MutablePoints f) const {
  VertexLoads loads;
  loads.shared[loads.count++] = {weights_.data(), Whole(at)};
  AddLoads(range, loads, at.v, f);
}

double SharedForce::Energy(const EvalContext& at) const { return -Whole(at).dot(at.x * weights_); }

}  // namespace phrenic
