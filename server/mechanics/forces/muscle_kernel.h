// SIMD kernel of muscle (muscle.h), one triangle per lane: the forces on the corners of each triangle are written to an
// array of their own, from which each vertex gathers its own. Google Highway compiles it for several instruction sets
// and selects the best one at run time. The results are bitwise equal on all of them: no target uses fused
// multiply-add, and all sum in the same order. `Number` is double, or float for half the memory and twice the lanes.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_MUSCLE_KERNEL_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_MUSCLE_KERNEL_H_

#include <cstdint>
#include <vector>

#include "server/mechanics/breathing/muscle_law.h"
#include "server/mechanics/forces/spring_kernel.h"

namespace phrenic {

// Triangles per batch.
template <typename Number>
inline constexpr int kMuscleLanes = kSliceRows<Number>;
// Corner forces of a batch, padded to four numbers each [Numbers].
template <typename Number>
inline constexpr int kCornerNumbers = 3 * 4 * kMuscleLanes<Number>;

// Triangles abc of one tissue and, if it is muscle, of one bundle. Padding has area 0 and all corners at one vertex.
template <typename Number>
struct alignas(64) MuscleBatch {
  // Gradients of the shape functions of b and c along and across the fibres at rest [1/m].
  Number b_along[kMuscleLanes<Number>] = {}, b_across[kMuscleLanes<Number>] = {};
  Number c_along[kMuscleLanes<Number>] = {}, c_across[kMuscleLanes<Number>] = {};
  Number area[kMuscleLanes<Number>] = {};                                      // at rest [m^2]
  Number along[kMuscleLanes<Number>] = {}, across[kMuscleLanes<Number>] = {};  // resting tensions [N/m]
  std::int32_t a[kMuscleLanes<Number>] = {}, b[kMuscleLanes<Number>] = {}, c[kMuscleLanes<Number>] = {};  // offsets
  Tissue tissue = Tissue::kPassive;
  int bundle = 0;
};

// Where the vertices of a body find the forces on their corners: slices of kGatherRows vertices, as many columns as the
// vertex with the most corners has, column by column. Padding is `zero`, an offset at which there are four zeros.
inline constexpr int kGatherRows = 8;
struct CornerSlices {
  std::int64_t vertices = 0;
  std::int32_t zero = 0;
  std::vector<std::int32_t> first;   // of each slice in `offset`, and the end
  std::vector<std::int32_t> offset;  // in the array of corner forces [Numbers]
};

template <typename Number>
struct MuscleLayout {
  std::vector<MuscleBatch<Number>> batches;  // sorted by tissue and bundle
  std::vector<int> first_of_bundle;          // batches of bundle b: first_of_bundle[b] to first_of_bundle[b + 1] - 1
  CornerSlices corners;
};

// Positions [m] and velocities [m/s] of all simulated vertices, kPointStride numbers each.
template <typename Number>
struct MusclePoints {
  const Number *x, *v;
};

// Sets the corner forces [N] of the batches [first, end): of corners a, b and c of each triangle
//   f_i = -A [T/l (f.g_i) F f + U/m (c.g_i) F c + G (F f . F c) ((f.g_i) F c + (c.g_i) F f)],
// l = |F f|, m = |F c|, T and U the tensions along and across by `law` plus viscosity times the rates of l and m, and G
// the shear stiffness. `active` has the active tension of each bundle at force-length 1 [N/m]. Thread-safe for disjoint
// batches.
void SetCornerForces(const MuscleLayout<double>& layout, std::int64_t first, std::int64_t end, const MuscleLaw& law,
                     const double* active, const MusclePoints<double>& points, double* corners);
void SetCornerForces(const MuscleLayout<float>& layout, std::int64_t first, std::int64_t end, const MuscleLaw& law,
                     const double* active, const MusclePoints<float>& points, float* corners);

// Adds to f, 3 x the body's vertices, the sum of each vertex' corner forces and, unless it is null, its load (3 x the
// same) [N], for the slices [first, end). Thread-safe for disjoint slices.
void GatherCorners(const CornerSlices& slices, std::int64_t first, std::int64_t end, const double* corners,
                   const double* load, double* f);
void GatherCorners(const CornerSlices& slices, std::int64_t first, std::int64_t end, const float* corners,
                   const double* load, double* f);

// Returns the sum of A dl/dt over the triangles of a bundle [m^2/s]. Thread-safe.
double SumStretchRates(const MuscleLayout<double>& layout, int bundle, const MusclePoints<double>& points);
double SumStretchRates(const MuscleLayout<float>& layout, int bundle, const MusclePoints<float>& points);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_MUSCLE_KERNEL_H_
