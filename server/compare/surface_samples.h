// Samples of a surface, each standing for a part of its area.
#ifndef PHRENIC_SERVER_COMPARE_SURFACE_SAMPLES_H_
#define PHRENIC_SERVER_COMPARE_SURFACE_SAMPLES_H_

#include <cstdint>
#include <optional>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "server/mesh/mesh.h"

namespace phrenic::compare {

// Each triangle is parted into n^2 equal ones of its own shape, n the least for which none of their edges is longer
// than `spacing`; a sample is the middle of a part (the midpoint rule: means converge with the square of the spacing).
struct Sampling {
  double spacing = 0;        // asked for [m]
  double longest = 0;        // the longest edge of a part [m]; at most `spacing`
  std::int64_t samples = 0;  // of the whole surface
};

// `spacing` [m]; where it is not given, one that gives about 50,000 samples or one a triangle, whichever is more.
// INVALID_ARGUMENT where it asks for more than 5,000,000.
absl::StatusOr<Sampling> PlanSampling(const ConstPoints& x, const Triangles& triangles, std::optional<double> spacing);

// Calls `visit` with each sample and the area it stands for [m^2]; samples follow each other near by.
void ForEachSample(const ConstPoints& x, const Triangles& triangles, const Sampling& sampling,
                   absl::FunctionRef<void(const Eigen::Vector3d& point, double area)> visit);

}  // namespace phrenic::compare

#endif  // PHRENIC_SERVER_COMPARE_SURFACE_SAMPLES_H_
