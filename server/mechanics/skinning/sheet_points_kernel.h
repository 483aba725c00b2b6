// SIMD kernel of PlaceOnSheet. Google Highway compiles it for several instruction sets and selects the best at run
// time; all give the same numbers. Thread-safe.
#ifndef PHRENIC_SERVER_MECHANICS_SKINNING_SHEET_POINTS_KERNEL_H_
#define PHRENIC_SERVER_MECHANICS_SKINNING_SHEET_POINTS_KERNEL_H_

#include <span>

#include "server/mechanics/skin.h"

namespace phrenic {

// A vertex of the middle surface, as the points bound to it need it, or its time derivative: position [m], area stretch
// [1], normal and padding. While the nodes are computed, sums over the triangles take the places of stretch and normal.
struct alignas(64) SheetNode {
  double numbers[8];
  auto position() { return Eigen::Map<Eigen::Vector3d>(numbers); }
  auto normal() { return Eigen::Map<Eigen::Vector3d>(numbers + 4); }
  double& stretch() { return numbers[3]; }
};

inline constexpr double kSmallestStretch = 1.0 / 8;  // of the area

// Sets x [m], three numbers a binding, to sum w p + H / J n: p, J and n the weighted positions, stretches and normals
// of the corners, n made a unit vector, J at least kSmallestStretch. `nodes` begin with the vertex `first`.
void PlaceBindings(std::span<const TriangleBinding> bindings, const SheetNode* nodes, int first, double* x);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SKINNING_SHEET_POINTS_KERNEL_H_
