// A generated lung moved onto a person's, from points inside it at end exhale: p = s * q + t, with a scale s per axis
// and a shift t, each lung apart.
//
// Minimises, with d the signed distance of a point from the scaled surface (positive outside) [mm] and a = ln(s/s0),
//   2 mean h(d + 2) + 1.5 sum a + sum a^2/0.3^2,  h(x) = x^2 up to 6 mm and 36 + 2 (x - 6) above, 0 for x < 0:
// the surface holds the points with a margin of 2 mm, a few outliers cost little, it is no larger than they need, and
// its extents are near those of the points' 0.5 to 99.5 percentiles (s0: those + 3 %). By BOBYQA of NLopt, without
// random numbers.
#ifndef PHRENIC_SERVER_FIT_REGISTRATION_H_
#define PHRENIC_SERVER_FIT_REGISTRATION_H_

#include <Eigen/Geometry>

#include "absl/status/statusor.h"
#include "server/mesh/mesh.h"

namespace phrenic::fit {

// A closed surface of a lung with its signed distance on a grid of 4 mm. Immutable, thread-safe.
class LungTemplate {
 public:
  // Requires: a closed surface that faces outwards [m].
  explicit LungTemplate(Mesh surface);
  const Mesh& surface() const { return surface_; }
  const Eigen::AlignedBox3d& box() const { return box_; }
  // Returns the distance from the surface [m], negative inside, trilinear between the grid's nodes; beyond the grid
  // that of its nearest point.
  double DistanceAt(const Eigen::Vector3d& point) const;

 private:
  double Node(int i, int j, int k) const { return distance_[i + size_.x() * (j + size_.y() * k)]; }

  Mesh surface_;
  Eigen::AlignedBox3d box_;
  Eigen::Vector3d origin_;
  Eigen::Vector3i size_;
  Eigen::VectorXd distance_;
};

struct Registration {
  Eigen::Vector3d scale = Eigen::Vector3d::Ones(), shift = Eigen::Vector3d::Zero();  // shift [m]
  double outside = 0;                                                                // share of the points
  double farthest = 0;                                                               // of them outside [m]

  Mesh Apply(Mesh surface) const;
  // Returns the place in the template.
  Eigen::Vector3d ToTemplate(const Eigen::Vector3d& point) const { return (point - shift).cwiseQuotient(scale); }
};

// Requires: at least 10 points [m]. FAILED_PRECONDITION if the scales are not between 0.4 and 2.5: the points are of
// something else. The same points give the same bits. At most 700 of the points, evenly chosen, are used.
absl::StatusOr<Registration> Register(const LungTemplate& lung, const Points& points);

}  // namespace phrenic::fit

#endif  // PHRENIC_SERVER_FIT_REGISTRATION_H_
