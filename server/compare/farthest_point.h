// One-sided Hausdorff distance of two triangle surfaces by branch and bound.
#ifndef PHRENIC_SERVER_COMPARE_FARTHEST_POINT_H_
#define PHRENIC_SERVER_COMPARE_FARTHEST_POINT_H_

#include "server/compare/measured_surface.h"

namespace phrenic::compare {

// Bounds of a one-sided Hausdorff distance.
struct Farthest {
  double found = 0;  // lower bound [m]: the distance of an existing point
  double bound = 0;  // upper bound [m]: no point is farther
};

// h(from, to) = max over p in `from` of min over q in `to` of |p - q|, by branch and bound over the triangles of
// `from`. The distance of a piece with corners v and centroid m is bounded by the smaller of
//   max |v - t|, t the triangle of `to` nearest to m   (the distance to a convex set is convex), and
//   d(m) + max |v - m|                                 (the distance is Lipschitz continuous with constant 1).
// The piece with the largest upper bound is split in four until `found` and `bound` differ by less than 1e-4 of `found`
// or 1e-9 m, or until 200,000 pieces were evaluated. (Bounds as in Guthe, Borodin, Klein, Fast and accurate Hausdorff
// distance calculation between meshes, 2005.) `distances` [m] are those of the vertices of `from`, one per vertex;
// `found` [m] is a distance that is known to occur. Requires: neither surface is empty. Thread-safe.
Farthest FindFarthest(const MeasuredSurface& from, const MeasuredSurface& to, const Eigen::VectorXd& distances,
                      double found);

}  // namespace phrenic::compare

#endif  // PHRENIC_SERVER_COMPARE_FARTHEST_POINT_H_
