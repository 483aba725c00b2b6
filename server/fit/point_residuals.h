// Points that were followed, against the model: landmarks in the lungs, and markers on the chest wall.
#ifndef PHRENIC_SERVER_FIT_POINT_RESIDUALS_H_
#define PHRENIC_SERVER_FIT_POINT_RESIDUALS_H_

#include "absl/status/statusor.h"
#include "server/fit/fit_space.h"
#include "server/fit/landmarks.h"
#include "server/fit/least_squares.h"
#include "server/fit/markers.h"
#include "server/fit/person.h"
#include "server/fit/residuals.h"

namespace phrenic::fit {

// Returns for each point the number of the points `among` that lie in its block of 40 mm: errors of neighbours are
// alike over 30 to 45 mm, so that a block counts as one datum. At least 1.
Eigen::VectorXd AlikeOnes(const Points& points, const std::vector<int>& among);

// Adds the residuals of pairs, motion - s (R a), per axis: s is 1 at the end of inspiration (phase 1, or no phases),
// and a fitted number for each other phase, whose prior is (1 - cos(pi phase))/2 +- 0.15. `halves`: those that are
// fitted, and those that are held out. INVALID_ARGUMENT for more than 20 phases.
absl::Status AddLandmarks(const KindOfData& kind, const Landmarks& landmarks, const Halves& halves,
                          const Person& person, FitSpace& space, AllResiduals& all);

// Adds the residuals n . (motion - shift) - n . (R a) of the markers beside the costal side of the lungs, within 80 mm
// of it, along its normal n (skin slides along the ribs), with a fitted shift of the whole body, 0 +- 5 mm an axis.
// With 20 of them or more, half is held out. INVALID_ARGUMENT if fewer than 3 are there.
absl::Status AddMarkers(const KindOfData& kind, const Markers& markers, const Person& person, std::uint64_t split,
                        FitSpace& space, AllResiduals& all);

}  // namespace phrenic::fit

#endif  // PHRENIC_SERVER_FIT_POINT_RESIDUALS_H_
