// Muscle fibres in the triangles of a surface. Passive, along and across the fibres:
//   E = 1/2 V modulus (l - 1)^2  [J];
// active, along the fibres only:
//   f = -V s breath_force max(0, signal(t)) dl/dx  [N].
// l = |F d| is the stretch of direction d, F the deformation gradient of a triangle of rest volume V = A h [m^3], s the
// active stress at the peak of a breath [Pa]; it is tensile only. Fibre directions follow the gradient of the harmonic
// function from one region to another, as in rule-based cardiac fibre models (Bayer et al. 2012). The live parameter
// elasticity scales the passive stiffness; apply_muscles switches the active stress.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_FIBRES_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_FIBRES_H_

#include <vector>

#include "server/mechanics/forces/corotated.h"
#include "server/mechanics/model_builder.h"

namespace phrenic {

class Fibres final : public Force {
 public:
  // Returns null, and reports it, if no triangle has fibres. A triangle on which the harmonic function is constant (it
  // lies in one of the two regions) has none. INVALID_ARGUMENT if a region does not exist or there is no harmonic
  // function between the two.
  static absl::StatusOr<std::unique_ptr<Force>> Make(const v1::Fibres& scene, const std::string& name,
                                                     std::string_view path, ModelBuilder& builder);

  void AddForce(const EvalContext& at, MutablePoints f) const override;
  void AddStiffness(const EvalContext& at, StiffnessSink& sink) const override;
  double Energy(const EvalContext& at) const override;
  bool conservative() const override { return true; }
  // Returns the unit fibre directions at rest, 3 x n, one column per triangle with fibres.
  Points Directions() const;

 private:
  struct Strip {
    FiniteElement<2> element;
    Eigen::Vector2d along;  // unit, in the element's axes
  };
  // The state of one material direction.
  struct Tension {
    double stretch, tension;  // -, [Pa]
    Eigen::Vector3d unit;     // the deformed direction
  };
  Fibres(std::string name, const v1::Fibres& scene)
      : Force(std::move(name)),
        along_(scene.modulus_along()),
        across_(scene.modulus_across()),
        active_stress_(scene.active_stress()) {}
  absl::Status AddBody(const v1::Fibres& scene, int body, std::string_view path, const ModelBuilder& builder);
  double ActiveStress(const EvalContext& at) const;
  static Tension TensionOf(const Eigen::Vector3d& stretched, double modulus, double active);

  std::vector<Strip> strips_;
  const double along_, across_, active_stress_;  // [Pa]
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_FIBRES_H_
