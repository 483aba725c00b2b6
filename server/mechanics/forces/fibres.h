// Muscle fibres in the triangles of a surface: passive along and across, E = 1/2 V modulus (l - 1)^2 [J], and active
// along, f = -V s breath_force max(0, signal(t)) dl/dx [N]; l = |F d| the stretch of direction d, F the deformation
// gradient of a triangle of rest volume V = A h, s the active stress at the peak of a breath [Pa]. Directions follow
// the gradient of the harmonic function from one region to another (as rule-based cardiac fibres do: Bayer et al.
// 2012). A muscle pulls and never pushes. Passive stiffness is scaled by the live parameter elasticity, the active pull
// is switched by apply_muscles.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_FIBRES_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_FIBRES_H_

#include <vector>

#include "server/mechanics/forces/corotated.h"
#include "server/mechanics/model_builder.h"

namespace phrenic {

class Fibres final : public Force {
 public:
  // Null where no triangle takes part. A triangle in which the harmonic function is level (the whole of it in one of
  // the two regions) has no fibres.
  static absl::StatusOr<std::unique_ptr<Force>> Make(const v1::Fibres& scene, const std::string& name,
                                                     std::string_view path, ModelBuilder& builder);

  void AddForce(const EvalContext& at, MutablePoints f) const override;
  void AddStiffness(const EvalContext& at, StiffnessSink& sink) const override;
  double Energy(const EvalContext& at) const override;
  bool conservative() const override { return true; }
  // Unit directions of the fibres at rest, by triangle that has them, 3 x n.
  Points Directions() const;

 private:
  struct Strip {
    FiniteElement<2> element;
    Eigen::Vector2d along;  // unit, in the element's axes
  };
  // What pulls along a direction: its stretch, the unit vector it has become, and its tension [Pa].
  struct Pull {
    double stretch, tension;
    Eigen::Vector3d unit;
  };
  Fibres(std::string name, const v1::Fibres& scene)
      : Force(std::move(name)),
        along_(scene.modulus_along()),
        across_(scene.modulus_across()),
        active_stress_(scene.active_stress()) {}
  absl::Status AddBody(const v1::Fibres& scene, int body, std::string_view path, const ModelBuilder& builder);
  double ActiveStress(const EvalContext& at) const;
  static Pull PullOf(const Eigen::Vector3d& stretched, double modulus, double active);

  std::vector<Strip> strips_;
  const double along_, across_, active_stress_;  // [Pa]
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_FIBRES_H_
