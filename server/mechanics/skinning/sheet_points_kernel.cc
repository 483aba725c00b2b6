#include "server/mechanics/skinning/sheet_points_kernel.h"

#include <algorithm>

#include "server/mechanics/linalg/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "server/mechanics/skinning/sheet_points_kernel.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace phrenic::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr size_t kTogether = 32;  // bindings

// The weighted sums of bindings, in two parts of four numbers each.
struct Sums {
  HWY_ALIGN double places[4 * kTogether];   // position and stretch
  HWY_ALIGN double normals[4 * kTogether];  // normal and padding
  HWY_ALIGN double heights[kTogether];
};

// Sets four of the eight numbers of a binding's sum.
HWY_INLINE void Weigh(const Eigen::Vector3d& weights, const double* a, const double* b, const double* c, double* to) {
  const hn::CappedTag<double, 4> d;
  for (size_t k = 0; k < 4; k += hn::Lanes(d)) {
    const auto part = [&](double weight, const double* from)
                          HWY_ATTR { return hn::Mul(hn::Set(d, weight), hn::Load(d, from + k)); };
    hn::Store(hn::Add(hn::Add(part(weights[0], a), part(weights[1], b)), part(weights[2], c)), d, to + k);
  }
}

HWY_INLINE void SumUp(const TriangleBinding& binding, const SheetNode* nodes, int first, size_t i, Sums& sums) {
  const auto node = [&](int corner) { return nodes[binding.corners[corner] - first].numbers; };
  const double *a = node(0), *b = node(1), *c = node(2);
  Weigh(binding.weights, a, b, c, sums.places + 4 * i);
  Weigh(binding.weights, a + 4, b + 4, c + 4, sums.normals + 4 * i);
  sums.heights[i] = binding.height;
}

// Lifts the points from `i` on, as many as a vector has.
HWY_INLINE void Lift(const Sums& sums, size_t i, double* x) {
  const hn::CappedTag<double, 8> d;
  hn::Vec<decltype(d)> px, py, pz, stretch, nx, ny, nz, padding;
  hn::LoadInterleaved4(d, sums.places + 4 * i, px, py, pz, stretch);
  hn::LoadInterleaved4(d, sums.normals + 4 * i, nx, ny, nz, padding);
  const auto squares = hn::Add(hn::Add(hn::Mul(nx, nx), hn::Mul(ny, ny)), hn::Mul(nz, nz));
  const auto length = hn::Sqrt(squares);
  const auto by = hn::IfThenElse(hn::Gt(length, hn::Zero(d)), length, hn::Set(d, 1.0));
  const auto height = hn::Div(hn::Load(d, sums.heights + i), hn::Max(stretch, hn::Set(d, kSmallestStretch)));
  const auto lifted = [&](auto place, auto normal)
                          HWY_ATTR { return hn::Add(place, hn::Mul(height, hn::Div(normal, by))); };
  hn::StoreInterleaved3(lifted(px, nx), lifted(py, ny), lifted(pz, nz), d, x + 3 * i);
}

void PlaceBindingsHere(std::span<const TriangleBinding> bindings, const SheetNode* nodes, int first, double* x) {
  Sums sums = {};
  double placed[3 * kTogether];
  for (size_t start = 0; start < bindings.size(); start += kTogether) {
    const size_t count = std::min(kTogether, bindings.size() - start);
    for (size_t i = 0; i < count; ++i) SumUp(bindings[start + i], nodes, first, i, sums);
    for (size_t i = 0; i < count; i += hn::Lanes(hn::CappedTag<double, 8>())) Lift(sums, i, placed);
    std::copy_n(placed, 3 * count, x + 3 * start);
  }
}

}  // namespace
}  // namespace phrenic::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace phrenic {

HWY_EXPORT(PlaceBindingsHere);

void PlaceBindings(std::span<const TriangleBinding> bindings, const SheetNode* nodes, int first, double* x) {
  HWY_DYNAMIC_DISPATCH(PlaceBindingsHere)(bindings, nodes, first, x);
}

}  // namespace phrenic
#endif  // HWY_ONCE
