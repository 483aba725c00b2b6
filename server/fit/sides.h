// Which points lie in the right lung and which in the left, and whether the axes can be LPS at all.
//
// In LPS the gap between the lungs lies along x, the lungs are wider at their bases (low z) than at their apices, the
// apices lie at the back (high y), and the heart takes more room in the front of the left lung (high x). Points for
// which one of these does not hold have swapped or reversed axes; nothing is guessed or repaired.
#ifndef PHRENIC_SERVER_FIT_SIDES_H_
#define PHRENIC_SERVER_FIT_SIDES_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "server/mesh/mesh.h"

namespace phrenic::fit {

inline constexpr int kFewestPoints = 100;
enum Side : int { kRight = 0, kLeft = 1 };

struct LungSides {
  std::vector<Side> of;             // of each point
  double gap = 0;                   // x of the plane between the lungs [m]
  std::vector<std::string> doubts;  // warnings about axes that the points do not determine
};

// Divides the points [m] of both lungs. INVALID_ARGUMENT says what cannot be right and what to check: fewer than
// kFewestPoints points, a number that is not finite, extents that are not those of lungs (the unit), axes. The gap is
// empty to 1 % in people, along other axes to 60 %. The other signs are refused if they are wrong by two standard
// errors of counting points, and in `doubts` if they are not right by as much. Thread-safe.
absl::StatusOr<LungSides> FindSides(const Points& points);

// Returns the indices of the points of one side.
std::vector<int> PointsOf(const LungSides& sides, Side side);

// Returns the value below which a fraction q of `values` lies, interpolated. Requires: values, q in 0..1.
double Quantile(std::vector<double> values, double q);

}  // namespace phrenic::fit

#endif  // PHRENIC_SERVER_FIT_SIDES_H_
