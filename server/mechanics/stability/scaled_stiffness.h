// What a model's vibrations follow from: M^-1/2 K M^-1/2, of which the eigenvalues are their frequencies squared; and
// with it the damping C that an integrator counts, where it is given weight.
#ifndef PHRENIC_SERVER_MECHANICS_STABILITY_SCALED_STIFFNESS_H_
#define PHRENIC_SERVER_MECHANICS_STABILITY_SCALED_STIFFNESS_H_

#include <vector>

#include "server/mechanics/linalg/large_pages.h"
#include "server/mechanics/solve/block_matrix.h"

namespace phrenic {

// K positive semi-definite, with what may yet wake (latent stiffness), in the instant that it is made from; zero rows
// and columns for what does not move. Springs are kept one by one: a few products are not worth a pattern. Not
// thread-safe.
class ScaledStiffness final : public StiffnessSink {
 public:
  ScaledStiffness(const Model& model, const EvalContext& at, Integrator::Damping counted);

  void Add(int i, int j, const Eigen::Matrix3d& block) override { blocks_.Add(i, j, block); }
  void AddSprings(std::span<const SpringStiffness> springs) override;
  void AddOuter(double scale, const Points& g) override { blocks_.AddOuter(scale, g); }

  // From now on K is K + weight C; `weight` in 1/s, 0 at first.
  void WeighDamping(double weight) { damping_weight_ = weight; }

  // y = M^-1/2 K M^-1/2 x, both of 3 n numbers.
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
  Eigen::VectorXd damping_;  // C's diagonal [N s/m], and the rest of it
  OuterProducts shared_damping_;
  double damping_weight_ = 0;
  LargeVector<Joint> joints_;
  Eigen::VectorXd scale_;
  Points scaled_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_STABILITY_SCALED_STIFFNESS_H_
