#include "server/mechanics/forces/muscle_layout.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace phrenic {
namespace {

using Group = std::pair<Tissue, int>;
Group GroupOf(const MuscleTriangle& triangle) { return {triangle.tissue, triangle.bundle}; }

// Returns the numbers of the triangles, sorted by tissue and bundle.
std::vector<int> SortedByGroup(const std::vector<MuscleTriangle>& triangles) {
  std::vector<int> order(triangles.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return GroupOf(triangles[a]) < GroupOf(triangles[b]); });
  return order;
}

template <typename Number>
MuscleBatch<Number> EmptyBatch(const MuscleTriangle& first) {
  MuscleBatch<Number> batch;
  batch.tissue = first.tissue, batch.bundle = first.bundle;
  for (std::int32_t* corner : {batch.a, batch.b, batch.c}) {
    std::fill_n(corner, kMuscleLanes<Number>, kPointStride<Number> * first.vertices[0]);
  }
  return batch;
}

template <typename Number>
void SetLane(const MuscleTriangle& triangle, int lane, MuscleBatch<Number>& batch) {
  const auto number = [](double value) { return static_cast<Number>(value); };
  batch.b_along[lane] = number(triangle.along[1]), batch.c_along[lane] = number(triangle.along[2]);
  batch.b_across[lane] = number(triangle.across[1]), batch.c_across[lane] = number(triangle.across[2]);
  batch.area[lane] = number(triangle.area);
  batch.along[lane] = number(triangle.resting_along), batch.across[lane] = number(triangle.resting_across);
  const Eigen::Vector3i offset = kPointStride<Number> * triangle.vertices;
  batch.a[lane] = offset[0], batch.b[lane] = offset[1], batch.c[lane] = offset[2];
}

// Returns the first batch of each bundle, and the end. Batches of muscle are the first.
template <typename Number>
std::vector<int> FirstOfBundles(const std::vector<MuscleBatch<Number>>& batches, int bundles) {
  std::vector<int> first;
  for (int bundle = 0; bundle <= bundles; ++bundle) {
    const auto found = std::find_if(batches.begin(), batches.end(), [bundle](const MuscleBatch<Number>& batch) {
      return batch.tissue != Tissue::kMuscle || batch.bundle >= bundle;
    });
    first.push_back(static_cast<int>(found - batches.begin()));
  }
  return first;
}

// `corners` has the offsets of each vertex' corners.
CornerSlices MakeCornerSlices(const std::vector<std::vector<std::int32_t>>& corners, std::int32_t zero) {
  CornerSlices slices{.vertices = static_cast<std::int64_t>(corners.size()), .zero = zero, .first = {0}, .offset = {}};
  for (size_t begin = 0; begin < corners.size(); begin += kGatherRows) {
    const size_t end = std::min(begin + kGatherRows, corners.size());
    size_t columns = 0;
    for (size_t v = begin; v < end; ++v) columns = std::max(columns, corners[v].size());
    const size_t first = slices.offset.size();
    slices.offset.resize(first + columns * kGatherRows, zero);
    for (size_t v = begin; v < end; ++v) {
      for (size_t c = 0; c < corners[v].size(); ++c) slices.offset[first + c * kGatherRows + v - begin] = corners[v][c];
    }
    slices.first.push_back(static_cast<std::int32_t>(slices.offset.size()));
  }
  return slices;
}

}  // namespace

template <typename Number>
MuscleLayout<Number> MakeMuscleLayout(const std::vector<MuscleTriangle>& triangles, int bundles,
                                      const VertexRange& vertices) {
  MuscleLayout<Number> layout;
  std::vector<std::vector<std::int32_t>> corners(vertices.end - vertices.first);
  Group group;
  int lane = kMuscleLanes<Number>;
  for (const int t : SortedByGroup(triangles)) {
    const MuscleTriangle& triangle = triangles[t];
    if (lane == kMuscleLanes<Number> || GroupOf(triangle) != group) {
      layout.batches.push_back(EmptyBatch<Number>(triangle));
      group = GroupOf(triangle);
      lane = 0;
    }
    SetLane(triangle, lane, layout.batches.back());
    const auto start = static_cast<std::int32_t>(layout.batches.size() - 1) * kCornerNumbers<Number>;
    for (int i = 0; i < 3; ++i) {
      const std::int32_t offset = start + 4 * i * kMuscleLanes<Number> + SlotOf<Number>(0, lane);
      corners[triangle.vertices[i] - vertices.first].push_back(offset);
    }
    ++lane;
  }
  layout.first_of_bundle = FirstOfBundles(layout.batches, bundles);
  const auto zero = static_cast<std::int32_t>(layout.batches.size()) * kCornerNumbers<Number>;
  layout.corners = MakeCornerSlices(corners, zero);
  return layout;
}

template MuscleLayout<float> MakeMuscleLayout(const std::vector<MuscleTriangle>&, int, const VertexRange&);
template MuscleLayout<double> MakeMuscleLayout(const std::vector<MuscleTriangle>&, int, const VertexRange&);

}  // namespace phrenic
