// Samples of a triangle surface, each with the area that it represents.
#ifndef PHRENIC_SERVER_COMPARE_SURFACE_SAMPLES_H_
#define PHRENIC_SERVER_COMPARE_SURFACE_SAMPLES_H_

#include <cstdint>
#include <optional>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "server/mesh/mesh.h"

namespace phrenic::compare {

// Each triangle is divided into n^2 congruent triangles similar to it, n the smallest number for which their edges are
// no longer than `spacing`. A sample is the centroid of such a part: the midpoint rule, of second order in the spacing.
struct Sampling {
  double spacing = 0;        // upper bound of the edges of parts [m]
  double longest = 0;        // the longest edge of a part [m]; at most `spacing`
  std::int64_t samples = 0;  // number of samples of the whole surface
};

// Plans the sampling of the surface x (3 x n [m]) with `spacing` [m]. Without `spacing` it chooses one that gives about
// 50,000 samples, and at least one per triangle. INVALID_ARGUMENT if the given spacing needs more than 5,000,000
// samples and more than one per triangle; the message names a spacing that works.
absl::StatusOr<Sampling> PlanSampling(const ConstPoints& x, const Triangles& triangles, std::optional<double> spacing);

// Calls `visit` with each sample [m] and the area that it represents [m^2]. Consecutive samples are near each other.
void ForEachSample(const ConstPoints& x, const Triangles& triangles, const Sampling& sampling,
                   absl::FunctionRef<void(const Eigen::Vector3d& point, double area)> visit);

}  // namespace phrenic::compare

#endif  // PHRENIC_SERVER_COMPARE_SURFACE_SAMPLES_H_
