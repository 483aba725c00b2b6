// Springs laid out for the machine: each vertex lists its own, so that every spring is worked out twice and nothing is
// scattered; vertices in blocks, sorted in each by the number of their springs, cut into slices (spring_kernel.h). Two
// that follow each other, and whose neighbours do, as in a sheet numbered row by row or in two sheets by turns, are
// taken together: what they need of others is then half as many reads.
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

// Immutable; any number of threads may call, each with scratch memory of its own. Where springs join vertices that are
// far apart, positions are first put into an order of their own.
class SpringRows {
 public:
  SpringRows() = default;
  // Of `vertices` simulated vertices. In single precision positions are rounded, as they lie from some vertex, and so
  // is all that is worked out from them: the force on a vertex, in each coordinate, is off by less than
  //   2^-19 sum over its springs of k (r + l) (1 + l0 / l),
  // r [m] its distance from there, l and l0 the spring's length and rest length; with a load, by 2^-22 of it more.
  SpringRows(const std::vector<Spring>& springs, int vertices, Precision precision = Precision::kDouble);

  // On the vertices that have springs acts a steady force too: `load` is 3 x n [N], and nothing on others.
  void SetLoad(const Points& load);
  // f += scale (pulls + load) [N], 3 x n. The sum of a vertex is taken in its neighbours' order, on every machine.
  void AddForce(double scale, const ConstPoints& x, const Scratch& scratch, MutablePoints f) const;

  // Whether the same can be had range by range: not in an order of its own.
  bool InRanges() const { return !ordered_; }
  // The same on the vertices of the range alone; what f held counts for nothing where it is `fresh`. In single
  // precision from `packed`, which is x as PackPoints has it.
  void AddForce(const VertexRange& range, double scale, const ConstPoints& x, const float* packed, bool fresh,
                MutablePoints f) const;

  Precision precision() const;
  // In single precision, the vertex to pack from: in the middle of theirs.
  int origin() const { return origin_; }

 private:
  std::variant<SpringSlices<double>, SpringSlices<float>> slices_;
  bool ordered_ = false;
  int origin_ = 0;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_SPRING_ROWS_H_
