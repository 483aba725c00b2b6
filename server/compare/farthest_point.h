// How far a surface's farthest point is from another surface, between two bounds that meet.
#ifndef PHRENIC_SERVER_COMPARE_FARTHEST_POINT_H_
#define PHRENIC_SERVER_COMPARE_FARTHEST_POINT_H_

#include "server/compare/measured_surface.h"

namespace phrenic::compare {

struct Farthest {
  double found = 0;  // the distance of a point that there is [m]
  double bound = 0;  // no point is farther [m]
};

// h(from, to) = max over p in `from` of min over q in `to` of |p - q|, by branch and bound over the triangles of
// `from`. A part with corners v and middle m is no farther than the smaller of
//   max |v - t|, t the triangle of `to` that is nearest to m   (the distance to a convex set is convex), and
//   d(m) + max |v - m|                                         (distances change no faster than points move);
// the part that may be farthest is parted in four until found and bound differ by 1e-4 of found, or 1e-9 m, or 200,000
// parts were looked at. (Bounds as in Guthe, Borodin, Klein, Fast and accurate Hausdorff distance calculation between
// meshes, 2005.) `distances` are those of the vertices of `from`, `found` one that is known to exist. Neither surface
// may be empty.
Farthest FindFarthest(const MeasuredSurface& from, const MeasuredSurface& to, const Eigen::VectorXd& distances,
                      double found);

}  // namespace phrenic::compare

#endif  // PHRENIC_SERVER_COMPARE_FARTHEST_POINT_H_
