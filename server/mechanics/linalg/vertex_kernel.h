// Operations on all vertices of a range, with vector instructions (Google Highway: the machine's best instruction set
// is chosen at run time, and all give the same bits). x and v are 3 x n, one column per simulated vertex; f has the
// columns of the range. Threads may call at once for different ranges.
#ifndef PHRENIC_SERVER_MECHANICS_LINALG_VERTEX_KERNEL_H_
#define PHRENIC_SERVER_MECHANICS_LINALG_VERTEX_KERNEL_H_

#include <array>
#include <cstddef>

#include "server/mechanics/linalg/state_bounds.h"
#include "server/mechanics/parallel/vertex_range.h"
#include "server/mesh/mesh.h"

namespace phrenic {

// A force that constant weights distribute over vertices.
struct SharedLoad {
  const double* weight = nullptr;                   // one per simulated vertex
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  // [N]
};

// Forces on vertices that do not depend on other vertices: -c v + sum of weight * force, in this order [N].
struct VertexLoads {
  static constexpr size_t kMost = 4;

  const double* c = nullptr;  // one per simulated vertex [N s/m]; null for no friction
  std::array<SharedLoad, kMost> shared = {};
  size_t count = 0;

  bool empty() const { return c == nullptr && count == 0; }
};

// Adds the loads to f.
void AddLoads(const VertexRange& range, const VertexLoads& loads, const ConstPoints& v, MutablePoints f);

// Sets v_next = v + kick w (f + loads), then x_next = x + drift v_next, for the vertices with w = 1/m > 0 [1/kg]; the
// others keep v and x. `kick` and `drift` are times [s]. x_next may be x, and v_next may be v. Returns the bounds of
// the result.
StateBounds KickAndDrift(const VertexRange& range, const Eigen::VectorXd& w, double kick, double drift,
                         const ConstPoints& f, const VertexLoads& loads, const Points& x, const Points& v,
                         Points& x_next, Points& v_next);

// Returns the bounds of a range.
StateBounds BoundsOf(const VertexRange& range, const Points& x, const Points& v);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_LINALG_VERTEX_KERNEL_H_
