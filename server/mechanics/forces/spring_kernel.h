// The inner loop of springs (springs.h), for each vertex the sum over its own: written once with Google Highway,
// compiled for several instruction sets, the machine's best chosen at run time. No target fuses a product into a sum,
// and all take the same sums in the same order, so that they give the same bits. `Number` is double, or float for
// half the memory and twice the springs an instruction.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_SPRING_KERNEL_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_SPRING_KERNEL_H_

#include <cstdint>
#include <type_traits>
#include <vector>

#include "server/mechanics/linalg/large_pages.h"
#include "server/mechanics/parallel/vertex_range.h"

namespace phrenic {

// Rows of a slice: one a vertex, all padded to the slice's longest.
template <typename Number>
inline constexpr int kSliceRows = 64 / sizeof(Number);

// From a point to the next [Numbers]. Those in single precision are four numbers each, so that one aligned load has one
// point: the last is not read for its value.
template <typename Number>
inline constexpr int kPointStride = std::is_same_v<Number, float> ? 4 : 3;

// How the points that a slice's rows are at, or a column of their neighbours, come out of x. One by one they are read
// with what follows; at the end without, as one of them is the last. In pairs: of every eight rows, the last four and
// all their neighbours follow the first four and theirs, whose places alone are noted, so that a read has two, and what
// follows.
enum class Fetching { kOneByOne, kAtEnd, kInPairs };
// In pairs, which of a column's places is the row's, and how many points from there its own is.
constexpr int PairOf(int row) { return row / 8 * 4 + row % 4; }
constexpr int PointOfPair(int row) { return row % 8 / 4; }

template <typename Number>
struct SpringSlice {
  int rows = 0;  // the others are padding
  Fetching fetching = Fetching::kOneByOne;
  std::int64_t first_column = 0, first_place = 0;
  std::int64_t first_stiffness = -1;  // of its columns; -1 where its springs are alike
  Number common_stiffness = 0;        // [N/m], where they are

  // Of a column.
  constexpr int places() const { return fetching == Fetching::kInPairs ? kSliceRows<Number> / 2 : kSliceRows<Number>; }
};
// A number for each row of a slice: for one spring of each, k l0 [N] or k [N/m].
template <typename Number>
struct alignas(64) SliceNumbers {
  Number row[kSliceRows<Number>] = {};
};
// A steady force on each row of a slice [N].
template <typename Number>
struct SliceLoad {
  SliceNumbers<Number> x, y, z;
};
// kVertexBlock vertices as the slices count them. Their sums are gathered in a tile before they are added to f.
struct SpringBlock {
  std::int64_t first_slice = 0;
  bool whole = false;  // nearly all its vertices have springs, and lie in f as they do in x
};

// Springs by vertex, in slices of rows: SELL-C-sigma (Kreutzer et al., SIAM J Sci Comput 2014;36:C401). Padding is a
// spring to itself, of no force at rest.
template <typename Number>
struct SpringSlices {
  std::vector<SpringBlock> blocks;              // and one more, for the end of its slices
  std::vector<SpringSlice<Number>> slices;      // and one more, for the end of its columns
  LargeVector<SliceNumbers<Number>> at_rest;    // a column
  LargeVector<SliceNumbers<Number>> stiffness;  // a column of the slices with springs that are not alike
  // Of each slice where its rows' vertices lie in x, then where each column's neighbours do [Numbers].
  LargeVector<std::int32_t> places;
  std::vector<SliceLoad<Number>> load;  // a slice, or none
  std::vector<std::uint16_t> slot;      // of each vertex in its block's tile
  std::vector<int> order;               // the vertices as the slices count them; none where they come so

  // The vertex of a slice's row, as the slices count them.
  int VertexOf(std::int64_t slice, int row) const {
    const std::int32_t* const own = &places[slices[slice].first_place];
    const bool in_pairs = slices[slice].fetching == Fetching::kInPairs;
    return in_pairs ? own[PairOf(row)] / kPointStride<Number> + PointOfPair(row) : own[row] / kPointStride<Number>;
  }
};

// Where the sum of a slice's row lies in a tile, so that one transposition of them all writes whole vectors.
template <typename Number>
constexpr int SlotOf(std::int64_t slice_in_block, int row) {
  constexpr int kRows = kSliceRows<Number>;
  return static_cast<int>(slice_in_block) * 4 * kRows + row % 4 * kRows + row / 4 * 4;
}
// That of a vertex without springs.
template <typename Number>
inline constexpr int kNoSlot = SlotOf<Number>(kVertexBlock / kSliceRows<Number>, 0);

// f += scale (sum over the row's springs of (k - k l0 / l) d + load) [N] for the vertices of blocks first to end - 1, d
// from the row's vertex to the neighbour, l its length [m]; a spring with l = 0 pulls at nothing. x are points in the
// slices' order, kPointStride numbers each; f has a column a simulated vertex, the first that of block `first`'s first
// vertex, or of vertex 0 where the slices have an order of their own; where it is `fresh`, which it cannot be in such
// an order, what it held counts for nothing. Any number of threads may call, at once only on different blocks.
void AddSprings(const SpringSlices<double>& slices, std::int64_t first, std::int64_t end, double scale, const double* x,
                bool fresh, double* f);
void AddSprings(const SpringSlices<float>& slices, std::int64_t first, std::int64_t end, double scale, const float* x,
                bool fresh, double* f);

// Points first to end - 1 of the 3 x n array x, from `origin` [m], in single precision; aligned to 16 bytes.
void PackPoints(const VertexRange& range, const double* x, const double* origin, float* packed);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_SPRING_KERNEL_H_
