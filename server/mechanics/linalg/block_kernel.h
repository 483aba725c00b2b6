// The inner loops of conjugate gradients on a symmetric matrix of 3 x 3 blocks, in single precision: written once with
// Google Highway, compiled for several instruction sets, the machine's best chosen at run time. No target fuses a
// product into a sum, and all take the same sums in the same order, so that they give the same bits.
#ifndef PHRENIC_SERVER_MECHANICS_LINALG_BLOCK_KERNEL_H_
#define PHRENIC_SERVER_MECHANICS_LINALG_BLOCK_KERNEL_H_

#include <cstddef>
#include <cstdint>
#include <vector>

namespace phrenic {

// Rows of a slice: one a free vertex, all padded to the slice's longest.
inline constexpr int kSliceLanes = 16;

struct alignas(64) Lanes {
  float at[kSliceLanes] = {};
};
struct alignas(64) LanePlaces {
  std::int32_t at[kSliceLanes] = {};
};
// One vector of a system: for each slice all x, all y, all z.
using RowVector = std::vector<Lanes>;
inline constexpr int kAxes = 3;
// What is gathered: a point a row, and parts of blocks.
struct alignas(16) Quad {
  float at[4] = {};
};

// Where a vertex is [m]: x, y, z and nothing.
struct alignas(32) Position {
  double at[4] = {};
};

// Of a column of springs [m]: what is small beside it is told by the exact one.
struct RestLengths {
  alignas(64) double exact[kSliceLanes] = {};
  Lanes rounded;
};

// Blocks as forces hand them over, but for springs. One on the diagonal takes two: xx, xy, xz, yy, yz, zz. One off it,
// K_ij with i < j, takes three: the symmetric part as on the diagonal and then (K_zy - K_yz)/2, (K_xz - K_zx)/2,
// (K_yx - K_xy)/2.
using BlockEntries = std::vector<Quad>;

// What lies off the diagonal, by vertex, in slices of rows: SELL-C-sigma (Kreutzer et al., SIAM J Sci Comput
// 2014;36:C401). A column is one neighbour of each row of its slice.
struct BlockColumns {
  std::vector<std::int64_t> first;     // of the slices, and the end
  std::vector<LanePlaces> neighbours;  // a column: four times the other vertex' row; padding is its own neighbour
  std::vector<Lanes> blocks;           // kSpringValues or kWholeValues a column
};
inline constexpr int kSpringValues = 4;  // vx, vy, vz, t of K_ij = -(v v^T + t I)
inline constexpr int kWholeValues = 9;   // row by row

// The matrix A = inertia + weight K, each vertex scaled by s so that its diagonal block has the trace 3: s_i A_ij s_j.
struct BlockSlices {
  BlockColumns springs, whole;
  std::vector<Lanes> spring_stiffness;  // a column of springs [N/m]; zeros are padding
  std::vector<RestLengths> spring_rest;
  std::vector<LanePlaces> entries;  // a column of whole blocks: twice the entry's place, plus 1 where it is seen from j
  std::vector<Lanes> scale;         // s, one a slice; 0 for rows that the last slice lacks
  // Six a slice each: xx, xy, xz, yy, yz, zz of A and of weight K; the factors of A = L D L^T, L_yx, L_zx, L_zy and
  // 1/D.
  std::vector<Lanes> diagonal, stiffness, factors;

  size_t size() const { return scale.size(); }
};

// Springs' blocks, as yet unscaled, from where each row is; the diagonal from them, from K's entries (none are zeros)
// and the inertia [kg], one a row; and the scale, which `packed` gets as x, its root as y.
void FillDiagonal(const BlockEntries& diagonal, const std::vector<Position>& positions, float elasticity,
                  const std::vector<Lanes>& inertia, float weight, BlockSlices& slices, Quad* packed);
// The blocks off it, scaled; padding's entry is at 0, and zero. `packed` as FillDiagonal left it.
void FillBlocks(const BlockEntries& entries, float weight, const Quad* packed, BlockSlices& slices);

// The direction p is kept row by row, as it is gathered: x, y, z and nothing.
void Pack(const RowVector& z, Quad* p);
// q = A p with this diagonal; p . q.
double Multiply(const BlockSlices& slices, const std::vector<Lanes>& diagonal, const Quad* p, RowVector& q);
// r -= along q, then q = the inverse of A's diagonal blocks times r; r . q.
double Descend(const BlockSlices& slices, float along, RowVector& q, RowVector& r);
// y += along p, then p = z + keep p.
void Turn(float along, float keep, const RowVector& z, RowVector& y, Quad* p);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_LINALG_BLOCK_KERNEL_H_
