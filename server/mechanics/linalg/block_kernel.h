// The inner loops of conjugate gradients with a symmetric matrix of 3 x 3 blocks, in single precision (Google Highway:
// the machine's best instruction set is chosen at run time). No target fuses multiplication and addition, and all sum
// in the same order, so that they give the same bits. Thread-safe.
#ifndef PHRENIC_SERVER_MECHANICS_LINALG_BLOCK_KERNEL_H_
#define PHRENIC_SERVER_MECHANICS_LINALG_BLOCK_KERNEL_H_

#include <cstddef>
#include <cstdint>
#include <vector>

namespace phrenic {

// Rows per slice, one per free vertex; all are padded to the slice's longest.
inline constexpr int kSliceLanes = 16;

struct alignas(64) Lanes {
  float at[kSliceLanes] = {};
};
struct alignas(64) LanePlaces {
  std::int32_t at[kSliceLanes] = {};
};
// A vector of unknowns: for each slice all x, all y, all z.
using RowVector = std::vector<Lanes>;
inline constexpr int kAxes = 3;
// The unit of gathers: the point of a row, or a part of a block.
struct alignas(16) Quad {
  float at[4] = {};
};

// Position of a vertex [m]: x, y, z and padding.
struct alignas(32) Position {
  double at[4] = {};
};

// Rest lengths of a column of springs [m]; small elongations are computed from the exact ones.
struct RestLengths {
  alignas(64) double exact[kSliceLanes] = {};
  Lanes rounded;
};

// Blocks of all forces except springs. A diagonal block takes two entries: xx, xy, xz, yy, yz, zz. An off-diagonal
// block K_ij with i < j takes three: the symmetric part in the same way, then (K_zy - K_yz)/2, (K_xz - K_zx)/2, (K_yx -
// K_xy)/2.
using BlockEntries = std::vector<Quad>;

// The off-diagonal blocks by vertex, in slices of rows: SELL-C-sigma (Kreutzer et al., SIAM J Sci Comput
// 2014;36:C401). A column has one neighbour for each row of its slice.
struct BlockColumns {
  std::vector<std::int64_t> first;     // of the slices, and the end
  std::vector<LanePlaces> neighbours;  // per column: four times the neighbour's row; padding is its own neighbour
  std::vector<Lanes> blocks;           // kSpringValues or kWholeValues per column
};
inline constexpr int kSpringValues = 4;  // vx, vy, vz, t of K_ij = -(v v^T + t I)
inline constexpr int kWholeValues = 9;   // row by row

// The matrix A = inertia + weight K, each vertex scaled by s so that its diagonal block has the trace 3: s_i A_ij s_j.
struct BlockSlices {
  BlockColumns springs, whole;
  std::vector<Lanes> spring_stiffness;  // per column of springs [N/m]; 0 for padding
  std::vector<RestLengths> spring_rest;
  std::vector<LanePlaces> entries;  // per column of whole blocks: twice the entry's index, plus 1 for the row of j
  std::vector<Lanes> scale;         // s, one per slice; 0 for rows that the last slice lacks
  // Six per slice: xx, xy, xz, yy, yz, zz of A and of weight K; L_yx, L_zx, L_zy and 1/D of the factors A = L D L^T.
  std::vector<Lanes> diagonal, stiffness, factors;

  size_t size() const { return scale.size(); }
};

// Computes the blocks of springs, unscaled, from the positions of the rows; the diagonal from them, from K's entries
// (empty for none) and from the inertia of each row [kg]; and the scale. Sets each `packed` to the scale and its root.
void FillDiagonal(const BlockEntries& diagonal, const std::vector<Position>& positions, float elasticity,
                  const std::vector<Lanes>& inertia, float weight, BlockSlices& slices, Quad* packed);
// Computes the scaled off-diagonal blocks. Entry 0 is zero and serves as padding. `packed` is that of FillDiagonal.
void FillBlocks(const BlockEntries& entries, float weight, const Quad* packed, BlockSlices& slices);

// Stores the direction z as p, row by row for gathers: x, y, z and padding.
void Pack(const RowVector& z, Quad* p);
// Sets q = A p with this diagonal. Returns p . q.
double Multiply(const BlockSlices& slices, const std::vector<Lanes>& diagonal, const Quad* p, RowVector& q);
// Sets r -= along q, then q to the inverse of A's diagonal blocks times r. Returns r . q.
double Descend(const BlockSlices& slices, float along, RowVector& q, RowVector& r);
// Sets y += along p, then p = z + keep p.
void Turn(float along, float keep, const RowVector& z, RowVector& y, Quad* p);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_LINALG_BLOCK_KERNEL_H_
