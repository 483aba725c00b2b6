// SIMD kernel of springs (springs.h): each vertex gathers the forces of its own springs. Google Highway compiles it for
// several instruction sets and selects the best one at run time. The results are bitwise equal on all of them: no
// target uses fused multiply-add, and all sum in the same order. `Number` is double, or float for half the memory and
// twice the lanes.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_SPRING_KERNEL_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_SPRING_KERNEL_H_

#include <cstdint>
#include <type_traits>
#include <vector>

#include "server/mechanics/linalg/large_pages.h"
#include "server/mechanics/parallel/vertex_range.h"

namespace phrenic {

// Rows of a slice: one per vertex, all padded to the length of the longest.
template <typename Number>
inline constexpr int kSliceRows = 64 / sizeof(Number);

// Distance between consecutive points [Numbers]. In single precision a point is padded to four numbers, so that one
// aligned load reads it; the value of the fourth is not used.
template <typename Number>
inline constexpr int kPointStride = std::is_same_v<Number, float> ? 4 : 3;

// How the positions of a slice's rows, or of one column of their neighbours, are gathered from x.
// kOneByOne: one load per point, which also reads the numbers after it.
// kAtEnd: one load per point, which reads nothing after it, because one of the points is the last of x.
// kInPairs: one load per two consecutive points, which also reads the numbers after them. In every eight rows, rows 4
// to 7 and all their neighbours are the successors of rows 0 to 3 and theirs; only the offsets of rows 0 to 3 are kept.
enum class GatherMode { kOneByOne, kAtEnd, kInPairs };
// With kInPairs: which of a column's offsets belongs to a row, and how many points after it the row's own point is.
constexpr int PairOf(int row) { return row / 8 * 4 + row % 4; }
constexpr int PointOfPair(int row) { return row % 8 / 4; }

template <typename Number>
struct SpringSlice {
  int rows = 0;  // used rows; the others are padding
  GatherMode gather = GatherMode::kOneByOne;
  std::int64_t first_column = 0, first_offset = 0;
  std::int64_t first_stiffness = -1;  // index of its first stiffness column; -1 if all stiffnesses are equal
  Number common_stiffness = 0;        // that stiffness [N/m], if first_stiffness is -1

  // The number of offsets of a column.
  constexpr int offsets() const { return gather == GatherMode::kInPairs ? kSliceRows<Number> / 2 : kSliceRows<Number>; }
};
// One column of a slice: k l0 [N] or k [N/m] of one spring of each row.
template <typename Number>
struct alignas(64) SliceNumbers {
  Number row[kSliceRows<Number>] = {};
};
// The constant load on each row of a slice [N].
template <typename Number>
struct SliceLoad {
  SliceNumbers<Number> x, y, z;
};
// kVertexBlock vertices in the order of the slices. Their sums are collected in a tile before they are added to f.
struct SpringBlock {
  std::int64_t first_slice = 0;
  bool whole = false;  // most vertices have springs, and f has the same vertex order as x: add all of them in sequence
};

// A sparse matrix of springs in the SELL-C-sigma format (Kreutzer et al., SIAM J Sci Comput 2014;36:C401): one row per
// vertex with its springs, rows sorted by length within each block and cut into slices. Padding is a spring from a
// vertex to itself with k l0 = 0, which exerts no force.
template <typename Number>
struct SpringSlices {
  std::vector<SpringBlock> blocks;              // and a sentinel, whose first_slice is the end
  std::vector<SpringSlice<Number>> slices;      // and a sentinel, whose first_column is the end
  LargeVector<SliceNumbers<Number>> at_rest;    // k l0, one per column [N]
  LargeVector<SliceNumbers<Number>> stiffness;  // k, one per column of the slices with different stiffnesses [N/m]
  // Per slice: the offsets in x of its rows' vertices, then of each column's neighbours [Numbers].
  LargeVector<std::int32_t> offsets;
  std::vector<SliceLoad<Number>> load;  // one per slice; empty without load
  std::vector<std::uint16_t> slot;      // of each vertex in its block's tile
  std::vector<int> order;               // the vertex at each position of the slices' order; empty if not reordered

  // The position in the slices' order of the vertex of a slice's row.
  int VertexOf(std::int64_t slice, int row) const {
    const std::int32_t* const own = &offsets[slices[slice].first_offset];
    const bool in_pairs = slices[slice].gather == GatherMode::kInPairs;
    return in_pairs ? own[PairOf(row)] / kPointStride<Number> + PointOfPair(row) : own[row] / kPointStride<Number>;
  }
};

// The offset of a row's sum in a tile. Chosen so that a transposition of the slice's sums stores full vectors.
template <typename Number>
constexpr int SlotOf(std::int64_t slice_in_block, int row) {
  constexpr int kRows = kSliceRows<Number>;
  return static_cast<int>(slice_in_block) * 4 * kRows + row % 4 * kRows + row / 4 * 4;
}
// The slot of vertices without springs.
template <typename Number>
inline constexpr int kNoSlot = SlotOf<Number>(kVertexBlock / kSliceRows<Number>, 0);

// Adds scale (sum over the row's springs of (k - k l0 / l) d + load) to f [N] for the vertices of the blocks
// [first, end), d the vector from the row's vertex to its neighbour and l its length [m]. A spring with l = 0 exerts no
// force. `x` has the points in the slices' order, kPointStride numbers each [m]. `f` is 3 x n in the order of the
// simulated vertices; its first column is the first vertex of block `first`, or vertex 0 if the slices are reordered.
// With `fresh` f is overwritten instead; requires that the slices are not reordered. Thread-safe for disjoint blocks.
void AddSprings(const SpringSlices<double>& slices, std::int64_t first, std::int64_t end, double scale, const double* x,
                bool fresh, double* f);
void AddSprings(const SpringSlices<float>& slices, std::int64_t first, std::int64_t end, double scale, const float* x,
                bool fresh, double* f);

// Sets `packed` to the points of `range` of x (3 x n) relative to `origin` [m], in single precision, four numbers each.
// Requires: `packed` is aligned to 16 bytes. Thread-safe for disjoint ranges.
void PackPoints(const VertexRange& range, const double* x, const double* origin, float* packed);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_SPRING_KERNEL_H_
