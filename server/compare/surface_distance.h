// Distance measures of two surfaces: mean (ASSD), RMS, percentiles, Hausdorff distance and surface Dice.
#ifndef PHRENIC_SERVER_COMPARE_SURFACE_DISTANCE_H_
#define PHRENIC_SERVER_COMPARE_SURFACE_DISTANCE_H_

#include <optional>

#include "absl/status/statusor.h"
#include "phrenic/v1/compare.pb.h"
#include "server/compare/measured_surface.h"

namespace phrenic::compare {

// Identifies the definition of the measures. It changes whenever a result of MeasureDistance would change.
inline constexpr char kDefinition[] = "phrenic-surface-distance-1: point to surface, area-weighted, unsigned";

// Options of a measurement.
struct DistanceOptions {
  double tolerance = 1e-3;             // of the surface Dice coefficient [m]
  std::optional<double> spacing = {};  // of the samples [m]; chosen by PlanSampling if not set
};

// Measures the distances of two surfaces [mm]. d(p, S) is the distance from a point p to the nearest point of the
// surface S; integrals are over the area of A or B:
//   mean_a_to_b = int d(p, B) dA / A      rms_a_to_b^2 = int d(p, B)^2 dA / A      hd_a_to_b = max d(p, B)
//   p95_a_to_b: the least d for which 95 % of the area of A has d(p, B) <= d
//   hd_max = max(hd_a_to_b, hd_b_to_a)    hd95_max = max(p95_a_to_b, p95_b_to_a)    hd95_pooled: p95 over both areas
//   assd = (int d(p, B) dA + int d(p, A) dB) / (A + B)
//   surface_dice = (area of A with d(p, B) <= tolerance + area of B with d(p, A) <= tolerance) / (A + B)
// (Aspert, Santa-Cruz, Ebrahimi, MESH, 2002; Nikolov et al., arXiv:1809.04430; Maier-Hein and Reinke, Metrics reloaded,
// 2024.) Integrals are sums over samples (surface_samples.h); the maxima are those of FindFarthest. All distances are
// NaN if a surface has no triangles; a mean is also NaN if its area is 0. `at_vertices`, if not null, gets d(vertex of
// a, B) [m], NaN for vertices without a triangle. INVALID_ARGUMENT if the spacing needs too many samples. Runs the two
// directions in two threads; the result does not depend on their timing.
absl::StatusOr<v1::SurfaceDistance> MeasureDistance(const MeasuredSurface& a, const MeasuredSurface& b,
                                                    const DistanceOptions& options,
                                                    Eigen::VectorXd* at_vertices = nullptr);

}  // namespace phrenic::compare

#endif  // PHRENIC_SERVER_COMPARE_SURFACE_DISTANCE_H_
