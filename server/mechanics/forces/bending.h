// Bending of a plate across its inner edges (Grinspun et al. 2003): E = 1/2 B w (t - t0)^2 [J], t the angle between the
// normals of the two triangles at an edge, w = |edge|^2 / (sum of both areas) at rest, B = E h^3 / (12 (1 - nu^2)) the
// flexural rigidity [N m]. Exact for a plate that is rolled up along the edges of a regular mesh. K is B w grad t
// grad t^T: what the angle's own curvature adds vanishes at rest and may be negative. A triangle that has shrunk to a
// line has no normal and is not bent.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_BENDING_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_BENDING_H_

#include <vector>

#include "server/mechanics/model_builder.h"

namespace phrenic {

class Bending final : public Force {
 public:
  // Null where no edge between two triangles takes part.
  static absl::StatusOr<std::unique_ptr<Force>> Make(const v1::Bending& scene, const std::string& name,
                                                     std::string_view path, ModelBuilder& builder);

  void AddForce(const EvalContext& at, MutablePoints f) const override;
  void AddStiffness(const EvalContext& at, StiffnessSink& sink) const override;
  double Energy(const EvalContext& at) const override;
  bool conservative() const override { return true; }

 private:
  struct Hinge {
    Eigen::Vector4i vertices;  // the edge's two, then the two opposite ones
    double stiffness;          // B w [N m]
    double rest_angle;         // [rad]
  };
  struct Bend {
    double angle = 0;                                                   // beyond that at rest, -pi to pi [rad]
    Eigen::Matrix<double, 3, 4> gradient = decltype(gradient)::Zero();  // by the positions of the four [rad/m]
  };
  explicit Bending(std::string name) : Force(std::move(name)) {}
  void AddBody(const BodyModel& body, const Selection& selection, double rigidity);
  static Bend BendOf(const Hinge& hinge, const ConstPoints& x);

  std::vector<Hinge> hinges_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_BENDING_H_
