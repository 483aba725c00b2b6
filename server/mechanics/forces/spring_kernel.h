// The inner loop of springs (springs.h), for each vertex the sum over its own: written once with Google Highway,
// compiled for several instruction sets, the machine's best chosen at run time. No target fuses a product into a sum,
// and all take the same sums in the same order, so that they give the same bits.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_SPRING_KERNEL_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_SPRING_KERNEL_H_

#include <cstdint>
#include <vector>

namespace phrenic {

// Rows of a slice: one a vertex, all padded to the slice's longest.
inline constexpr int kSliceRows = 8;

// A neighbour is one aligned load of 32 bytes.
struct alignas(32) PackedPoint {
  double x = 0, y = 0, z = 0, unused = 0;  // [m]
};
inline constexpr int kPackedStride = sizeof(PackedPoint) / sizeof(double);

// One spring of each row of a slice. Padding has no stiffness.
struct alignas(64) SpringColumn {
  double stiffness[kSliceRows] = {};  // k [N/m]
  double at_rest[kSliceRows] = {};    // k l0 [N]
};
// Where the other ends of a column's springs are packed [doubles]; padding is its own neighbour.
struct SpringNeighbours {
  std::int32_t place[kSliceRows] = {};
};
// A steady force on each row of a slice [N].
struct alignas(64) SliceLoad {
  double x[kSliceRows] = {}, y[kSliceRows] = {}, z[kSliceRows] = {};
};

// Springs by vertex, in slices of rows: SELL-C-sigma (Kreutzer et al., SIAM J Sci Comput 2014;36:C401).
struct SpringSlices {
  std::vector<int> vertices;               // of the rows, the simulated vertex
  std::vector<std::int64_t> first_column;  // of the slices, and the end
  std::vector<SpringColumn> columns;
  std::vector<SpringNeighbours> neighbours;  // a column
  std::vector<SliceLoad> load;               // a slice, or none
};

// f += scale (sum over the row's springs of (k - k l0 / l) d + load) [N], d from the row's vertex to the neighbour, l
// its length [m]; a spring with l = 0 pulls at nothing. `packed` has a position a row, those that the last slice lacks
// as well; f is 3 x n, one column a simulated vertex. Any number of threads may call.
void AddSlices(const SpringSlices& slices, double scale, const PackedPoint* packed, double* f);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_SPRING_KERNEL_H_
