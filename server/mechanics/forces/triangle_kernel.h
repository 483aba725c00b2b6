// The inner loop of triangles that are free to turn (corotated.h), several at a time: written once with Google Highway,
// compiled for several instruction sets, the machine's best chosen at run time. No target fuses a product into a sum,
// and all add to a vertex in the triangles' order, so that they give the same bits.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_TRIANGLE_KERNEL_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_TRIANGLE_KERNEL_H_

#include <cstdint>
#include <vector>

namespace phrenic {

inline constexpr int kBatch = 8;

// Triangles abc side by side. Those that the last batch lacks have no volume and are all at vertex 0.
struct alignas(64) TriangleBatch {
  double b1[kBatch] = {}, b2[kBatch] = {};                      // gradient of the shape function of b [1/m]
  double c1[kBatch] = {}, c2[kBatch] = {};                      // and of c
  double volume[kBatch] = {};                                   // [m^3]
  std::int32_t a[kBatch] = {}, b[kBatch] = {}, c[kBatch] = {};  // place of the vertices' coordinates, thrice the vertex
};

// f += the forces -dE/dx [N], 3 x n as x [m]: with F = R S, P = 2 mu F + (lambda (tr S - 2) - 2 mu) R, which is
// R (2 mu e + lambda tr(e) I), and f_b = -V P g_b; R = (F + cofactor(F))/tr S. Nothing is added for triangles that have
// no area in space: their numbers are appended to `flat`.
void AddTriangles(const std::vector<TriangleBatch>& batches, double mu, double lambda, const double* x, double* f,
                  std::vector<int>& flat);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_TRIANGLE_KERNEL_H_
