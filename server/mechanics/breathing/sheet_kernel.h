// SIMD kernel of the area vectors of a sheet (thorax_pressures.h), eight triangles at a time. Google Highway compiles
// it for several instruction sets and selects the best one at run time. The results are bitwise equal on all of them.
#ifndef PHRENIC_SERVER_MECHANICS_BREATHING_SHEET_KERNEL_H_
#define PHRENIC_SERVER_MECHANICS_BREATHING_SHEET_KERNEL_H_

#include <array>
#include <cstdint>
#include <vector>

#include "server/mechanics/breathing/chamber_kernel.h"

namespace phrenic {

// A vertex has a multiple of so many places for the triangles around it: loops of one length are the fastest.
inline constexpr int kRingPlaces = 8;

// Triangles right of the midline and left of it, and the triangles around each vertex.
struct SheetLayout {
  std::array<std::vector<TrianglePacket>, 2> packets;  // right, left
  std::vector<std::int32_t> first;                     // of each vertex in `around`, and the end
  // Offsets in the array of areas [doubles]: four times the triangle's place, or that of the four zeros after all
  // triangles.
  std::vector<std::int32_t> around;
  int first_vertex = 0;  // simulated

  std::ptrdiff_t vertices() const { return static_cast<std::ptrdiff_t>(first.size()) - 1; }
  std::size_t triangles() const { return kPacketTriangles * (packets[0].size() + packets[1].size()); }
};

// A linear field p(x) = slope . x - offset.
struct LinearField {
  double slope[3] = {}, offset = 0;

  bool operator==(const LinearField&) const = default;
};

// Sets four numbers of each triangle abc in `areas`: (b - a) x (c - a)/6 [m^2] and the mean of the field on it. Returns
// the volumes of the cones from `apex` over the triangles of each side [m^3]. x is 3 x n. Requires, here and below: the
// areas are aligned to 32 bytes, as those of an Eigen vector are. Thread-safe.
std::array<double, 2> SetAreas(const SheetLayout& layout, const double* x, const double* apex, const LinearField& field,
                               double* areas);

// Requires: four zeros follow the areas of the triangles. Sets `slopes`, 3 x the sheet's vertices, to the sum s_i of
// the areas around each vertex [m^2], and `push`, the same, to the forces of a pressure p(x) [Pa]: (s_i p(x_i) + 3 sum
// of area times mean p)/4 [N].
void GatherAreas(const SheetLayout& layout, const double* areas, const double* x, const LinearField& field,
                 double* slopes, double* push);

// Sums of the products of two arrays: {where `on_left` is 0, where it is 1}. All have the same size.
std::array<double, 2> SumBySide(const std::vector<double>& on_left, const double* a, const double* b);
// Sets `to` to values times `right` where `on_left` is 0, times `left` where it is 1; or adds that to it.
void AddBySide(const std::vector<double>& on_left, double right, double left, const double* values, double* to);
void SetBySide(const std::vector<double>& on_left, double right, double left, const double* values, double* to);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_BREATHING_SHEET_KERNEL_H_
