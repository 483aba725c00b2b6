// Springs in a layout for SIMD evaluation. Each vertex lists its own springs: every spring is evaluated twice, and no
// force is scattered. Vertices are divided into blocks, sorted in each by their number of springs and cut into slices
// (spring_kernel.h). Two consecutive vertices whose neighbours are consecutive too (as in a sheet numbered row by row,
// or in two sheets numbered alternately) are paired, which halves the number of loads.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_SPRING_ROWS_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_SPRING_ROWS_H_

#include <variant>
#include <vector>

#include "server/mechanics/forces/spring_kernel.h"
#include "server/mechanics/parallel/vertex_range.h"
#include "server/mechanics/scratch.h"
#include "server/mechanics/spring.h"
#include "server/mesh/mesh.h"

namespace phrenic {

enum class Precision { kDouble, kSingle };

// Immutable and thread-safe, for threads with scratch memory of their own. If springs connect vertices that are far
// apart in memory, the vertices are reordered (Cuthill-McKee), and positions are copied to that order first.
class SpringRows {
 public:
  SpringRows() = default;
  // `vertices` is the number of simulated vertices. In single precision, positions relative to the vertex origin() and
  // all that is computed from them are rounded. The error of each component of the force on a vertex is less than
  //   2^-19 sum over its springs of k (r + l) (1 + l0 / l)  [N],
  // r the vertex's distance from that origin [m], l and l0 the spring's length and rest length [m]; a load adds 2^-22
  // of itself.
  SpringRows(const std::vector<Spring>& springs, int vertices, Precision precision = Precision::kDouble);

  // Adds a constant load, 3 x n [N], on the vertices with springs. Requires: it is 0 on all others.
  void SetLoad(const Points& load);
  // Adds scale (spring forces + load) to f [N], 3 x n. Sums over a vertex's springs in the order of its neighbours, on
  // every machine.
  void AddForce(double scale, const ConstPoints& x, const Scratch& scratch, MutablePoints f) const;

  // True if ranges of vertices can be evaluated separately: the vertices are not reordered.
  bool InRanges() const { return !ordered_; }
  // Adds the same for the vertices of the range only; overwrites f (3 x the range's vertices) with `fresh`. In single
  // precision it reads `packed`, x as converted by PackPoints, instead of x. Requires: InRanges().
  void AddForce(const VertexRange& range, double scale, const ConstPoints& x, const float* packed, bool fresh,
                MutablePoints f) const;

  Precision precision() const;
  // The vertex that positions are relative to in single precision: an end of the middle spring.
  int origin() const { return origin_; }

 private:
  std::variant<SpringSlices<double>, SpringSlices<float>> slices_;
  bool ordered_ = false;  // the vertices are reordered
  int origin_ = 0;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_SPRING_ROWS_H_
