// Which states of two motions are compared with each other.
#ifndef PHRENIC_SERVER_COMPARE_MOMENTS_H_
#define PHRENIC_SERVER_COMPARE_MOMENTS_H_

#include <optional>
#include <vector>

#include "absl/status/statusor.h"
#include "server/meshio/motion.h"

namespace phrenic::compare {

// A state of a motion: between step `step` and the next one, `weight` of the way.
struct Between {
  int step = 0;
  double weight = 0;
};

// The state at a time; none where the motion, which has at least two, has no such time.
std::optional<Between> FindTime(const std::vector<double>& times, double time);

// One pair of states.
struct Moment {
  std::optional<double> time;  // of A, or of B where A stands still [s]; none where neither moves
  Between a, b;
};

struct MatchedMoments {
  std::vector<Moment> pairs;
  int left_out = 0;  // times of A that are outside those of B
};

// A moment for each time of A, with B interpolated linearly in time; for each time of B where A stands still; one where
// neither moves. With `match_phases` the times of B are stretched to begin and end with those of A.
// FAILED_PRECONDITION where the motions share no time.
absl::StatusOr<MatchedMoments> MatchTimes(const meshio::Motion& a, const meshio::Motion& b, bool match_phases);

// Where the vertices are, 3 x n [m]; a motion of no times stays as its file's nodes have it.
Points PositionsAt(const meshio::Motion& motion, const Between& at);

}  // namespace phrenic::compare

#endif  // PHRENIC_SERVER_COMPARE_MOMENTS_H_
