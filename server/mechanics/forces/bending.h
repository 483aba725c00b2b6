// Bending of a thin plate, discrete at its interior edges (Grinspun et al. 2003). The energy of an edge is
//   E = 1/2 B w (t - t0)^2  [J],
// t the dihedral angle between the normals of its two triangles [rad], t0 that at rest, w = |edge|^2 / (sum of both
// areas) at rest, B = E h^3 / (12 (1 - nu^2)) the flexural rigidity [N m]. Exact for a plate that is rolled up along
// the edges of a regular mesh. The stiffness is the Gauss-Newton part B w grad t grad t^T [N/m]; the second derivative
// of t is left out, because its term vanishes at rest and may be indefinite. A degenerate triangle has no normal and
// contributes no force.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_BENDING_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_BENDING_H_

#include <vector>

#include "server/mechanics/model_builder.h"

namespace phrenic {

class Bending final : public Force {
 public:
  // Returns null, and reports it, if no interior edge is selected.
  static absl::StatusOr<std::unique_ptr<Force>> Make(const v1::Bending& scene, const std::string& name,
                                                     std::string_view path, ModelBuilder& builder);

  void AddForce(const EvalContext& at, MutablePoints f) const override;
  void AddStiffness(const EvalContext& at, StiffnessSink& sink) const override;
  double Energy(const EvalContext& at) const override;
  bool conservative() const override { return true; }

 private:
  struct Hinge {
    Eigen::Vector4i vertices;  // the two of the edge, then the two opposite it
    double stiffness;          // B w [N m]
    double rest_angle;         // [rad]
  };
  struct Bend {
    double angle = 0;                                                   // t - t0, -pi to pi [rad]
    Eigen::Matrix<double, 3, 4> gradient = decltype(gradient)::Zero();  // of t, one column per vertex [rad/m]
  };
  explicit Bending(std::string name) : Force(std::move(name)) {}
  void AddBody(const BodyModel& body, const Selection& selection, double rigidity);
  static Bend BendOf(const Hinge& hinge, const ConstPoints& x);

  std::vector<Hinge> hinges_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_BENDING_H_
