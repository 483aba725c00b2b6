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

struct SpringSlice {
  std::int32_t own[kSliceRows] = {};  // where the row's vertex lies in x and f [doubles]
  int rows = 0;                       // the others are padding
  bool at_end = false;                // one of its springs, or rows, is of the last vertex of all
  std::int64_t first_column = 0;
};
// One spring of each row of a slice. Padding is a spring to itself, of no force at rest.
struct alignas(64) SpringColumn {
  double at_rest[kSliceRows] = {};  // k l0 [N]
};
struct alignas(64) ColumnStiffness {
  double k[kSliceRows] = {};  // [N/m]
};
// Where the other ends of a column's springs lie in x [doubles].
struct SpringNeighbours {
  std::int32_t place[kSliceRows] = {};
};
// A steady force on each row of a slice [N].
struct alignas(64) SliceLoad {
  double x[kSliceRows] = {}, y[kSliceRows] = {}, z[kSliceRows] = {};
};

// Springs by vertex, in slices of rows: SELL-C-sigma (Kreutzer et al., SIAM J Sci Comput 2014;36:C401).
struct SpringSlices {
  std::vector<SpringSlice> slices;  // and one more, for the end of its columns
  std::vector<SpringColumn> columns;
  std::vector<SpringNeighbours> neighbours;  // a column
  std::vector<ColumnStiffness> stiffness;    // a column; none where all springs are alike
  double common_stiffness = 0;               // [N/m], where they are
  std::vector<SliceLoad> load;               // a slice, or none
};

// f += scale (sum over the row's springs of (k - k l0 / l) d + load) [N] for the rows of slices first to end - 1, d
// from the row's vertex to the neighbour, l its length [m]; a spring with l = 0 pulls at nothing. x and f are 3 x n,
// one column a simulated vertex. Any number of threads may call, at once only on different slices.
void AddSlices(const SpringSlices& slices, std::int64_t first, std::int64_t end, double scale, const double* x,
               double* f);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_SPRING_KERNEL_H_
