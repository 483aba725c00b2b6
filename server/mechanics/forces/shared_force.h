// A force that is one vector at any moment, shared out among vertices: f_i = s_i F(t) [N], energy -F . sum s_i x_i.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_SHARED_FORCE_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_SHARED_FORCE_H_

#include <string>
#include <utility>
#include <vector>

#include "server/mechanics/block_force.h"
#include "server/mechanics/model_builder.h"

namespace phrenic {

class SharedForce : public BlockForce {
 public:
  // F at this moment.
  virtual Eigen::Vector3d Whole(const EvalContext& at) const = 0;
  // s, one a simulated vertex; and whether any of a block (kVertexBlock) is not 0.
  const Eigen::VectorXd& share() const { return share_; }
  bool ActsOn(Eigen::Index block) const { return acts_[static_cast<size_t>(block)]; }

  void AddForceToBlock(const VertexRange& range, const BlockContext& at, MutablePoints f) const override;
  double Energy(const EvalContext& at) const override;
  bool conservative() const override { return true; }

 protected:
  explicit SharedForce(std::string name) : BlockForce(std::move(name)) {}
  void SetShare(Eigen::VectorXd share);

 private:
  Eigen::VectorXd share_;
  std::vector<bool> acts_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_SHARED_FORCE_H_
