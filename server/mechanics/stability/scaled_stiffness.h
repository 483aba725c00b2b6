// M^-1/2 K M^-1/2, whose eigenvalues are the squared frequencies of a model's vibrations [rad^2/s^2], optionally with
// the damping C that limits an integrator's step.
#ifndef PHRENIC_SERVER_MECHANICS_STABILITY_SCALED_STIFFNESS_H_
#define PHRENIC_SERVER_MECHANICS_STABILITY_SCALED_STIFFNESS_H_

#include <memory>

#include "server/mechanics/linalg/large_pages.h"
#include "server/mechanics/solve/block_matrix.h"

namespace phrenic {

// K is positive semi-definite and includes inactive contacts and slack cables (latent stiffness), at the moment of
// construction. Rows and columns of vertices that do not move are 0. Springs are kept one by one: for a few products no
// pattern pays. Not thread-safe.
class ScaledStiffness final : public StiffnessSink {
 public:
  ScaledStiffness(const Model& model, const EvalContext& at, Integrator::Damping counted);

  void Add(int i, int j, const Eigen::Matrix3d& block) override { blocks_.Add(i, j, block); }
  void AddSprings(std::span<const SpringStiffness> springs) override;
  void AddOuter(double scale, const Points& g) override { blocks_.AddOuter(scale, g); }

  // Replaces K by K + weight C, `weight` [1/s]; initially 0.
  void WeighDamping(double weight) { damping_weight_ = weight; }

  // Sets y = M^-1/2 K M^-1/2 x, both of 3 n numbers.
  void Times(const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::VectorXd& y);
  const Eigen::VectorXd& scale() const { return scale_; }  // M^-1/2 [kg^-1/2]

 private:
  struct Joint {
    int a, b;
    double along[3];    // sqrt(axial) e
    double transverse;  // [N/m]
  };

  void AddJoints(double* y) const;

  BlockMatrix blocks_;
  Eigen::VectorXd damping_;  // C's diagonal [N s/m]; the rest is shared_damping_
  OuterProducts shared_damping_;
  std::unique_ptr<BlockMatrix> viscosity_;  // null if no force has viscosity, or it is left out
  double damping_weight_ = 0;
  LargeVector<Joint> joints_;
  Eigen::VectorXd scale_;
  Points scaled_, viscous_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_STABILITY_SCALED_STIFFNESS_H_
