// Finds numbers within bounds at which deviations vanish, without derivatives.
//
// Minimises the sum of squared deviations d_k(x) by BOBYQA (M. J. D. Powell, report DAMTP 2009/NA06, Cambridge): a
// quadratic model through 2n + 1 points in a trust region inside the bounds. It draws no random numbers, and x is
// rounded to four digits before it is tried, so that what is printed is what was tried.
#ifndef PHRENIC_SERVER_CALIBRATE_SEARCH_H_
#define PHRENIC_SERVER_CALIBRATE_SEARCH_H_

#include <span>
#include <string>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"

namespace phrenic::calibrate {

using Numbers = std::vector<double>;

// One entry a number.
struct SearchSpace {
  Numbers low, high;  // low < high
  Numbers start;      // within the bounds
  Numbers step;       // how far the first points lie from the start; positive
};

struct SearchLimits {
  double tolerance = 0.01;  // the search ends where no deviation is larger
  int tries = 60;           // of different points
};

struct Nearest {
  enum class End { kReached, kConverged, kTries };
  Numbers at, deviations;  // where the sum of squares was least
  double largest = 0;      // deviation there, without sign
  int tries = 0;
  End end = End::kConverged;
};

// Returns the deviations at a point, not a number where they cannot be measured. An error ends the search.
using Deviations = absl::FunctionRef<absl::StatusOr<Numbers>(std::span<const double>)>;

// Calls `deviations` on this thread, once for each point. Repeats itself bit for bit. Returns the first error of
// `deviations`; INTERNAL if NLopt refuses the space.
absl::StatusOr<Nearest> Search(const SearchSpace& space, const SearchLimits& limits, Deviations deviations);

}  // namespace phrenic::calibrate

#endif  // PHRENIC_SERVER_CALIBRATE_SEARCH_H_
