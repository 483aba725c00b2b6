// Pairs the states of two motions by time.
#ifndef PHRENIC_SERVER_COMPARE_MOMENTS_H_
#define PHRENIC_SERVER_COMPARE_MOMENTS_H_

#include <optional>
#include <vector>

#include "absl/status/statusor.h"
#include "server/meshio/motion.h"

namespace phrenic::compare {

// A state of a motion, interpolated linearly between the steps `step` and `step` + 1.
struct Between {
  int step = 0;
  double weight = 0;  // of the later step, 0 to 1
};

// Returns the state at `time` [s]; nullopt if it lies outside `times`. Times are equal within 1e-8 relative (files
// write nine digits). Requires: `times` has at least two entries and increases.
std::optional<Between> FindTime(const std::vector<double>& times, double time);

// One pair of states of A and B.
struct Moment {
  std::optional<double> time;  // of A, or of B if A does not move [s]; nullopt if neither moves
  Between a, b;
};

struct MatchedMoments {
  std::vector<Moment> pairs;
  int left_out = 0;  // number of times of A that lie outside those of B
};

// Returns one moment per time of A, with B interpolated linearly in time; one per time of B if A does not move; a
// single one if neither moves. `match_phases` maps the times of B linearly onto the interval of A. FAILED_PRECONDITION
// if the motions have no common time.
absl::StatusOr<MatchedMoments> MatchTimes(const meshio::Motion& a, const meshio::Motion& b, bool match_phases);

// Returns the positions of the vertices, 3 x n [m]; the nodes of the file if the motion has no times.
Points PositionsAt(const meshio::Motion& motion, const Between& at);

}  // namespace phrenic::compare

#endif  // PHRENIC_SERVER_COMPARE_MOMENTS_H_
