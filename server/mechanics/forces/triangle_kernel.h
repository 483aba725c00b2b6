// SIMD kernel of corotational triangles (corotated.h), one triangle per lane. Google Highway compiles it for several
// instruction sets and selects the best one at run time. The results are bitwise equal on all of them: no target uses
// fused multiply-add, and all add to a vertex in the order of the triangles.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_TRIANGLE_KERNEL_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_TRIANGLE_KERNEL_H_

#include <cstdint>
#include <vector>

namespace phrenic {

inline constexpr int kBatch = 8;

// kBatch triangles abc, one per lane. Padding in the last batch has volume 0 and all corners at vertex 0.
struct alignas(64) TriangleBatch {
  double b1[kBatch] = {}, b2[kBatch] = {};                      // gradient of the shape function of b [1/m]
  double c1[kBatch] = {}, c2[kBatch] = {};                      // and of c
  double volume[kBatch] = {};                                   // [m^3]
  std::int32_t a[kBatch] = {}, b[kBatch] = {}, c[kBatch] = {};  // offsets of the corners in x, 3 x vertex [doubles]
};

// Adds the forces -dE/dx to f [N]; x [m] and f are 3 x n. With F = R S and R = (F + cofactor(F))/tr S, the first
// Piola-Kirchhoff stress is P = 2 mu F + (lambda (tr S - 2) - 2 mu) R = R (2 mu e + lambda tr(e) I) [Pa], and
// f_b = -V P g_b. Triangles with zero current area are skipped and their indices appended to `flat`. Thread-safe for
// different f and `flat`.
void AddTriangles(const std::vector<TriangleBatch>& batches, double mu, double lambda, const double* x, double* f,
                  std::vector<int>& flat);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_TRIANGLE_KERNEL_H_
