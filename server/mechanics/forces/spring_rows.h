// Springs laid out for the machine: each vertex lists its own, so that every spring is worked out twice and nothing is
// scattered; vertices in blocks, sorted in each by the number of their springs, cut into slices (spring_kernel.h).
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_SPRING_ROWS_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_SPRING_ROWS_H_

#include <vector>

#include "server/mechanics/forces/spring_kernel.h"
#include "server/mechanics/vertex_range.h"
#include "server/mesh/mesh.h"

namespace phrenic {

struct Spring {
  int a, b;            // simulated vertices
  double stiffness;    // [N/m]
  double rest_length;  // [m]
};

// Immutable; any number of threads may call. Working memory is the thread's own: where springs join vertices that are
// far apart, a thread's first call on more vertices than any before allocates.
class SpringRows {
 public:
  SpringRows() = default;
  // Of `vertices` simulated vertices.
  SpringRows(const std::vector<Spring>& springs, int vertices);

  // On the vertices that have springs acts a steady force too: `load` is 3 x n [N], and nothing on others.
  void SetLoad(const Points& load);
  // f += scale (pulls + load) [N], 3 x n. The sum of a vertex is taken in the springs' order, on every machine.
  void AddForce(double scale, const ConstPoints& x, MutablePoints f) const;

  // Whether the same can be had range by range: not where vertices are put into an order of their own, as those that
  // springs join are too far apart as they come.
  bool InRanges() const { return order_.empty(); }
  // The same on the vertices of the range alone.
  void AddForce(const VertexRange& range, double scale, const ConstPoints& x, MutablePoints f) const;

 private:
  std::int64_t FirstSlice(Eigen::Index vertex) const {
    return first_slice_[(vertex + kVertexBlock - 1) / kVertexBlock];
  }

  SpringSlices slices_;
  std::vector<std::int64_t> first_slice_;  // of the blocks, and the end
  std::vector<int> order_;                 // vertices as the slices count them; none where they come so
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_SPRING_ROWS_H_
