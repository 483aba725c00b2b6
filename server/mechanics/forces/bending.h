// Bending of a thin isotropic plate or shell by the positions of its vertices alone: a Morley element whose slopes
// across edges follow from dihedral angles (mesh/plate_curvature.h has its equations). The energy of a triangle is
//   E = D/2 |sum_e b_e (t_e - t0_e)|^2 = D A/2 ((1 - nu) k:k + nu tr(k)^2)  [J],
// t_e the dihedral angle of an edge [rad], t0 at rest, k the change of curvature [1/m], D = E h^3 / (12 (1 - nu^2)) the
// flexural rigidity [N m]. Rotations may be large, and a rigid motion changes nothing. Deflections of a plate converge
// at second order on irregular meshes; borders are free, or supported where their vertices are held; a sheet is clamped
// at a row of triangles whose vertices are all held. The stiffness is the Gauss-Newton part D b b^T grad t grad t^T
// [N/m]: the second derivative of t is left out, because its term vanishes at rest and may be indefinite. An edge with
// a degenerate triangle has no angle. Morley 1968; discrete shells with angles: Grinspun et al. 2003 and 2006.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_BENDING_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_BENDING_H_

#include <vector>

#include "server/mechanics/model_builder.h"
#include "server/mesh/plate_curvature.h"

namespace phrenic {

class Bending final : public Force {
 public:
  // Returns null, and reports it, if no triangle with a neighbour is selected. Errors: those of the names and regions.
  static absl::StatusOr<std::unique_ptr<Force>> Make(const v1::Bending& scene, const std::string& name,
                                                     std::string_view path, ModelBuilder& builder);

  void AddForce(const EvalContext& at, MutablePoints f) const override;
  void AddStiffness(const EvalContext& at, StiffnessSink& sink) const override;
  double Energy(const EvalContext& at) const override;
  bool conservative() const override { return true; }

 private:
  struct Hinge {
    Eigen::Vector4i vertices;  // simulated: the two of the edge, then the two opposite it
    double rest_angle;         // [rad]
  };
  struct Bend {
    double angle = 0;                                                   // t - t0, -pi to pi [rad]
    double moment = 0;                                                  // dE/dt [J]
    Eigen::Matrix<double, 3, 4> gradient = decltype(gradient)::Zero();  // of t, one column per vertex [rad/m]
  };
  struct Bends {
    std::vector<Bend> of;  // one per hinge
  };
  Bending(std::string name, double rigidity) : Force(std::move(name)), rigidity_(rigidity) {}
  void AddBody(const BodyModel& body, Plate plate);
  static Bend BendOf(const Hinge& hinge, const ConstPoints& x);
  std::vector<Bend>& BendsAt(const EvalContext& at) const;
  static Eigen::Vector3d CurvatureOf(const PlateTriangle& triangle, const std::vector<Bend>& bends);

  const double rigidity_;  // [N m]
  std::vector<Hinge> hinges_;
  std::vector<PlateTriangle> triangles_;  // vertices are simulated ones
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_BENDING_H_
