// Springs laid out for the machine: each vertex lists its own, so that every spring is worked out twice and nothing is
// scattered; vertices in blocks, sorted in each by the number of their springs, cut into slices (spring_kernel.h).
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_SPRING_ROWS_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_SPRING_ROWS_H_

#include <variant>
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

enum class Precision { kDouble, kSingle };

// Immutable; any number of threads may call. Working memory is the thread's own: where positions are packed, as in
// single precision and where springs join vertices that are far apart, a thread's first call on more vertices than any
// before allocates.
class SpringRows {
 public:
  SpringRows() = default;
  // Of `vertices` simulated vertices. In single precision positions are rounded from the place of a vertex of theirs,
  // and so is all that is worked out from them: the force on a vertex, in each coordinate, is off by less than
  //   2^-19 sum over its springs of k (r + l) (1 + l0 / l),
  // r [m] its distance from that vertex, l and l0 the spring's length and rest length; with a load, by 2^-22 of it more.
  SpringRows(const std::vector<Spring>& springs, int vertices, Precision precision = Precision::kDouble);

  // On the vertices that have springs acts a steady force too: `load` is 3 x n [N], and nothing on others.
  void SetLoad(const Points& load);
  // f += scale (pulls + load) [N], 3 x n. The sum of a vertex is taken in the springs' order, on every machine.
  void AddForce(double scale, const ConstPoints& x, MutablePoints f) const;

  // Whether the same can be had range by range: not where positions are packed first.
  bool InRanges() const { return !packed_; }
  // The same on the vertices of the range alone.
  void AddForce(const VertexRange& range, double scale, const ConstPoints& x, MutablePoints f) const;

 private:
  std::variant<SpringSlices<double>, SpringSlices<float>> slices_;
  bool packed_ = false;
  int origin_ = 0;  // a vertex
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_SPRING_ROWS_H_
