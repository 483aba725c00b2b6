// The motion of lung tissue as a sum of few shapes, so that the whole interior of a lung follows from a state in
// microseconds instead of milliseconds:
//   u(x) = sum_k q_k u_k(x),   q = P g + p r   [m],
// with g the normal displacement of what touches each point of the surface, and the descent of the root's points [m], p
// a pressure on the free surface over the contact's stiffness [m], P and r a constant matrix and vector, and u_k the
// responses of the elastic, sliding tissue (lung_tissue.h) to smooth motions of the surroundings. P and r are given for
// each of several weights of the lung.
//
// How the shapes are made. Of each neighbour, the displacement is written in Legendre polynomials over the lung's box:
// of the diaphragm the vertical part to degree 5 and the horizontal one to degree 2 in x and y; of the wall all parts
// to degree 3; of the mediastinum a sideways one to degree 1 in x and y and, at the root, the vertical one to degree 1
// in z; of each also a uniform one along the normal, so that the fit sweeps the volume that g does. These are 101
// candidates, which P fits to g by area-weighted least squares. The shapes are the combinations of their responses, and
// of that to the pressure, under all weights, that move the tissue most: the leading eigenvectors of the Gram matrix,
// until the rest is below kLeftOut of the mean square, at most kMostShapes. A weight's responses are fitted to the
// shapes by least squares again.
//
// Motion that is not smooth is lost: tests/physiology/live_lungs_test.cc states the error against the full solution.
#ifndef PHRENIC_SERVER_MECHANICS_LUNGS_LUNG_RESPONSES_H_
#define PHRENIC_SERVER_MECHANICS_LUNGS_LUNG_RESPONSES_H_

#include <cstddef>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "server/mechanics/lungs/lung_surroundings.h"
#include "server/mechanics/lungs/lung_tissue.h"
#include "server/mechanics/lungs/lung_weight.h"

namespace phrenic {

// Lung tissue at a point, relative to rest.
struct TissueAtPoint {
  Eigen::Vector3d displacement;  // [m]
  Eigen::Matrix3d gradient;      // du_i/dx_j [1]

  // Volume gained per volume at rest: div u [1].
  double Ventilation() const { return gradient.trace(); }
  // The largest principal value of the small strain, (du_i/dx_j + du_j/dx_i)/2 [1].
  double LargestStrain() const;
};

// Immutable, thread-safe.
class LungResponses {
 public:
  static constexpr int kMostShapes = 96;
  static constexpr double kLeftOut = 1e-5;

  // Factorises the tissue with its free points, and solves for all candidates, under each of the weights: half a second
  // each. `neighbours` are those of the tissue's boundary points. The status of `stop`. Requires: a weight.
  static absl::StatusOr<LungResponses> Make(const LungTissue& tissue, const std::vector<LungNeighbour>& neighbours,
                                            const std::vector<LungWeight>& weights, const StopCheck& stop = {});

  // Tissue that moves by given shapes (3 nodes x shapes), of which the caller knows the amplitudes.
  LungResponses(BrickGrid grid, Eigen::MatrixXd shapes) : grid_(std::move(grid)), shapes_(std::move(shapes)) {}

  // Returns the amplitudes P g [m] for displacements of the surroundings at the boundary points (3 x points) [m], under
  // the weight of this index. Free points are not read. Requires: made by Make.
  Eigen::VectorXd Amplitudes(const ConstPoints& displacement, size_t weight = 0) const;
  // Returns r [1].
  const Eigen::VectorXd& PerPressure(size_t weight = 0) const { return responses_[weight].per_pressure; }
  // Returns the displacement of the grid's nodes (3 x nodes) [m].
  Points Nodes(const Eigen::VectorXd& amplitudes) const;
  // Returns the tissue at a point, whose place is where it is at rest; outside the lung as in the nearest brick.
  TissueAtPoint At(const Eigen::VectorXd& amplitudes, const Eigen::Vector3d& point) const;

  const BrickGrid& grid() const { return grid_; }
  // The displacement of the nodes per amplitude, row 3 node + axis (3 nodes x shapes) [1].
  const Eigen::MatrixXd& shapes() const { return shapes_; }

 private:
  // Under one weight.
  struct Response {
    Eigen::MatrixXd projection;  // P: shapes x (touching, then rooted points)
    Eigen::VectorXd per_pressure;
  };
  LungResponses(const LungTissue& tissue, const std::vector<LungNeighbour>& neighbours);
  // Returns g: what the amplitudes follow, of displacements of the surroundings (3 x points) [m].
  Eigen::VectorXd Followed(const ConstPoints& displacement) const;
  // Returns the matrix that fits the candidates (row 3 point + axis) to g.
  Eigen::MatrixXd FitOf(const Eigen::MatrixXd& candidates, const Eigen::VectorXd& areas) const;
  void Reduce(const std::vector<Eigen::MatrixXd>& under_weights, const Eigen::MatrixXd& fit);

  BrickGrid grid_;
  std::vector<Eigen::Index> touching_;  // the boundary points that are not free
  std::vector<Eigen::Index> rooted_;    // those of the root
  Points normals_;                      // of the touching ones
  std::vector<Response> responses_;     // by the weights
  Eigen::MatrixXd shapes_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_LUNGS_LUNG_RESPONSES_H_
