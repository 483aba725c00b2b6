// The elastic interior of a lung that slides on what surrounds it. For a normal displacement g of the surroundings [m],
// the displacement u of the tissue [m] minimises
//   E = 1/2 integral sigma(u) : eps(u) dV + 1/2 integral k (n . u - g)^2 dS   [J],
// with linear isotropic elasticity and n the outward normal of the surface. The pleura transmits no shear: nothing acts
// along the surface, but at the root (lung_root.h), where the tissue is glued: k (u - d)^2 with d the displacement of
// what holds it. The result depends on k/E and Poisson's ratio only, not on Young's modulus E. The tissue is
// homogeneous unless it has a weight (lung_weight.h), which makes E that times the modulus m; k keeps to E at the
// middle.
//
// Bricks of a regular grid, of which only the parts in the lung are material (brick_grid.h); the parts outside have
// 0.001 of its stiffness. The surface integral is a sum over the triangles' centroids. Rotations that no normal
// displacement determines (of a ball) are held by a stiffness of 1e-9 of the mean diagonal. u is linear in g.
//
// Values of the defaults: ../shared/motion.md (dense landmarks of ten people's CT).
#ifndef PHRENIC_SERVER_MECHANICS_LUNGS_LUNG_TISSUE_H_
#define PHRENIC_SERVER_MECHANICS_LUNGS_LUNG_TISSUE_H_

#include <Eigen/Geometry>
#include <Eigen/SparseCore>
#include <memory>
#include <vector>

#include "absl/status/statusor.h"
#include "server/mechanics/lungs/brick_grid.h"
#include "server/mechanics/lungs/layered_cholesky.h"
#include "server/mechanics/lungs/lung_root.h"
#include "server/mechanics/lungs/lung_weight.h"
#include "server/mechanics/stop_check.h"
#include "server/mesh/mesh.h"

namespace phrenic {

struct LungElasticity {
  double edge = 0.014;    // of the bricks [m]
  double poisson = 0.3;   // [1]
  double contact = 500;   // k/E, stiffness along the normal per area and modulus [1/m]
  double tangential = 0;  // the same along the surface [1/m]; as large as `contact`: glued
  LungWeight weight = {};
  LungRoot root = {};  // where it is glued
};

// What moves a lung, as displacements of the grid's nodes (3 x nodes).
struct PressedLung {
  Points followed;  // by the surroundings [m]
  Points pressed;   // by a pressure of one Young's modulus outwards on the free surface [m]
};

// Checks that a surface can be a lung of bricks with this edge [m]: INVALID_ARGUMENT if it is not closed, does not face
// outwards or has too many bricks.
absl::Status CheckLungSurface(const Mesh& surface, double edge = LungElasticity().edge);

// Immutable, thread-safe.
class LungTissue {
 public:
  static constexpr double kMostBricks = 8000;  // of the bounding box

  // Factorises the stiffness of a lung: 0.1 s for 4,500 unknowns. INVALID_ARGUMENT if the surface is not closed or does
  // not face outwards, or a number is out of range; the status of `stop`.
  static absl::StatusOr<LungTissue> Make(const Mesh& surface, const LungElasticity& elasticity = {},
                                         const StopCheck& stop = {});

  // Returns the same lung under another weight, without a factorisation: each of its solutions costs one.
  LungTissue Under(const LungWeight& weight) const;

  // The boundary points, in the order of the surface's triangles: centroids [m], outward unit normals (zero for a
  // triangle without area), areas [m^2].
  const Points& points() const { return points_; }
  const Points& normals() const { return normals_; }
  const Eigen::VectorXd& areas() const { return areas_; }
  // True for the boundary points of the root.
  const std::vector<bool>& rooted() const { return rooted_; }

  const Mesh& surface() const { return surface_; }
  const BrickGrid& grid() const { return grid_; }
  const Eigen::AlignedBox3d& box() const { return box_; }  // of the surface [m]
  // True if the point is inside the surface. O(triangles).
  bool Contains(const Eigen::Vector3d& point) const;

  // Returns the displacement of the grid's nodes (3 x nodes) [m] for the normal displacement g of each boundary point
  // [m]. The surface is free where g is NaN, which costs a factorisation; 4 ms without.
  Points Solve(const Eigen::VectorXd& g) const;
  // The same for displacements of the surroundings at the boundary points (3 x points) [m], whose part along the
  // surface acts through the tangential stiffness. The surface is free at columns with NaN.
  Points SolveVectors(const ConstPoints& displacement) const;
  // The same, and the response to a pressure on the free surface: u + p v, v the second one, is the displacement under
  // a pressure p [E]. What touches the rest stays where it is, so that a pressure moves nothing there.
  PressedLung SolvePressed(const ConstPoints& displacement) const;
  // Returns the displacement of the nodes (3 nodes x columns) for each column of displacements of the surroundings (row
  // 3 point + axis) [m]; the surface is free at the points that `free` marks, where they act as the pressure k n . d.
  // Costs a factorisation if it marks any. The status of `stop`.
  absl::StatusOr<Eigen::MatrixXd> SolveEach(const Eigen::MatrixXd& displacements, const std::vector<bool>& free,
                                            const StopCheck& stop = {}) const;
  // Returns the displacement u of the nodes [m] that minimises E + w/2 sum |u(x_i) - r_i|^2 for surroundings at rest:
  // the smallest deformation through the vectors r (3 x n) [m] at the points x (3 x n) [m], per modulus; `weight` w
  // [m]. Costs a factorisation. INVALID_ARGUMENT if it fails: a vector that is not finite, or points without number.
  absl::StatusOr<Points> SolveThrough(const ConstPoints& points, const ConstPoints& vectors, double weight) const;
  // Returns E per Young's modulus [m^3] of a displacement of the nodes.
  double Energy(const Points& nodes, const ConstPoints& displacement) const;

  // Displacement [m] and its gradient du_i/dx_j [1] at a point, by a displacement of the nodes; outside the lung those
  // of the nearest brick.
  Eigen::Vector3d DisplacementAt(const Points& nodes, const Eigen::Vector3d& point) const;
  Eigen::Matrix3d GradientAt(const Points& nodes, const Eigen::Vector3d& point) const;

 private:
  using Matrix = Eigen::SparseMatrix<double>;

  LungTissue(const Mesh& surface, const LungElasticity& elasticity);
  // Stiffness of the tissue and of the springs of all boundary points that are not free, lower triangle.
  Matrix Stiffness(const std::vector<bool>& free) const;
  // Forces of the springs on the nodes, per modulus.
  Eigen::VectorXd Forces(const ConstPoints& displacement) const;
  // Of LayeredCholesky.
  std::vector<int> LayerStarts() const;
  std::optional<LayeredCholesky> Factorise(const std::vector<bool>& free, const StopCheck& stop) const;
  // The factors with free points: those that are kept if there are none. Null if stopped.
  std::shared_ptr<const LayeredCholesky> FactorsWith(const std::vector<bool>& free, const StopCheck& stop) const;
  Eigen::Matrix3d SpringOf(Eigen::Index point) const;

  LungElasticity elasticity_;
  Mesh surface_;
  Points points_, normals_;
  Eigen::VectorXd areas_;
  std::vector<bool> rooted_;
  Eigen::AlignedBox3d box_;
  BrickGrid grid_;
  std::vector<BrickGrid::Place> places_;            // of the boundary points
  std::shared_ptr<const LayeredCholesky> factors_;  // of no free points, shared by copies; null after Under
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_LUNGS_LUNG_TISSUE_H_
