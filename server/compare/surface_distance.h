// How far two surfaces are from each other.
#ifndef PHRENIC_SERVER_COMPARE_SURFACE_DISTANCE_H_
#define PHRENIC_SERVER_COMPARE_SURFACE_DISTANCE_H_

#include <optional>

#include "absl/status/statusor.h"
#include "phrenic/v1/compare.pb.h"
#include "server/compare/measured_surface.h"

namespace phrenic::compare {

// The name of what MeasureDistance measures; it changes when a number would.
inline constexpr char kDefinition[] = "phrenic-surface-distance-1: point to surface, area-weighted, unsigned";

struct DistanceOptions {
  double tolerance = 1e-3;             // of surface Dice [m]
  std::optional<double> spacing = {};  // of the samples [m]; PlanSampling's where it is not set
};

// Each number of SurfaceDistance [mm], with d(p, S) the distance of a point to the nearest point of surface S, and dA
// over the area of A and of B:
//   mean_a_to_b = int d(p, B) dA / A      rms_a_to_b^2 = int d(p, B)^2 dA / A      hd_a_to_b = max d(p, B)
//   p95_a_to_b: the least d for which 95 % of the area of A has d(p, B) <= d
//   hd_max = max(hd_a_to_b, hd_b_to_a)    hd95_max = max(p95_a_to_b, p95_b_to_a)    hd95_pooled: p95 over both areas
//   assd = (int d(p, B) dA + int d(p, A) dB) / (A + B)
//   surface_dice = (area of A with d(p, B) <= tolerance + area of B with d(p, A) <= tolerance) / (A + B)
// (Aspert, Santa-Cruz, Ebrahimi, MESH, 2002; Nikolov et al., arXiv:1809.04430; Maier-Hein and Reinke, Metrics reloaded,
// 2024.) Integrals are sums over samples (surface_samples.h); the maxima are FindFarthest's. All distances are NaN
// where a surface has no triangle, the means also where neither has area. `at_vertices`, where it is not null, gets
// d(vertex of a, B) [m], NaN for vertices that are in no triangle. INVALID_ARGUMENT where the spacing asks for too many
// samples. Works in two threads.
absl::StatusOr<v1::SurfaceDistance> MeasureDistance(const MeasuredSurface& a, const MeasuredSurface& b,
                                                    const DistanceOptions& options,
                                                    Eigen::VectorXd* at_vertices = nullptr);

}  // namespace phrenic::compare

#endif  // PHRENIC_SERVER_COMPARE_SURFACE_DISTANCE_H_
