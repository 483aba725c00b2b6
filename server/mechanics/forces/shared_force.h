// A total force distributed over vertices by constant weights: f_i = s_i F(t) [N], E = -F . sum s_i x_i [J].
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_SHARED_FORCE_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_SHARED_FORCE_H_

#include <string>
#include <utility>
#include <vector>

#include "server/mechanics/block_force.h"
#include "server/mechanics/model_builder.h"

namespace phrenic {

// Thread-safe. A step adds all forces of this kind to a block in one pass (step/load_batch.h).
class SharedForce : public BlockForce {
 public:
  // Returns F at this moment [N].
  virtual Eigen::Vector3d Whole(const EvalContext& at) const = 0;
  // The weights s, one per simulated vertex.
  const Eigen::VectorXd& weights() const { return weights_; }
  // True if any weight in this block of kVertexBlock vertices is not 0.
  bool ActsOn(Eigen::Index block) const { return acts_[static_cast<size_t>(block)]; }

  void AddForceToBlock(const VertexRange& range, const BlockContext& at, MutablePoints f) const override;
  double Energy(const EvalContext& at) const override;
  bool conservative() const override { return true; }

 protected:
  explicit SharedForce(std::string name) : BlockForce(std::move(name)) {}
  void SetWeights(Eigen::VectorXd weights);

 private:
  Eigen::VectorXd weights_;
  std::vector<bool> acts_;  // one per block
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_SHARED_FORCE_H_
