// Distances between predicted and true motion of landmarks, and the reference models that a fit is compared with.
#ifndef PHRENIC_SERVER_FIT_ERRORS_H_
#define PHRENIC_SERVER_FIT_ERRORS_H_

#include <string>
#include <vector>

#include "server/fit/least_squares.h"
#include "server/mesh/mesh.h"

namespace phrenic::fit {

struct ErrorSummary {
  double mean = 0, p95 = 0;  // of the distances [m]; NaN without points
};

// Returns the mean and the 95th percentile of the columns' lengths.
ErrorSummary Summarise(const Points& difference);
ErrorSummary Summarise(const Points& difference, const std::vector<int>& indices);

struct Baseline {
  std::string name;
  int numbers;  // that are fitted
  ErrorSummary held_out;
};

// Fits each plain model to the fitting half and judges it on the other: no motion; a rigid shift (3 numbers); a line in
// z for the motion along z (2); that with a slope in y (3); an affine map (12). Requires: pairs; both halves have
// points.
std::vector<Baseline> FitBaselines(const Points& exhale, const Points& motion, const Halves& halves);

struct RegionError {
  std::string name;  // "base third", "front", "left"
  int points;
  double motion;  // mean length of the true motion [m]
  ErrorSummary error;
};

// Returns the errors of the points `indices` by thirds of height and by halves, those with points. `places`:
// Person::PlacesAt, one column per point; `left`: one entry per point.
std::vector<RegionError> ErrorsByRegion(const Points& places, const std::vector<bool>& left, const Points& motion,
                                        const Points& difference, const std::vector<int>& indices);

}  // namespace phrenic::fit

#endif  // PHRENIC_SERVER_FIT_ERRORS_H_
