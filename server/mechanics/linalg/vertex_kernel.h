// What is done to every vertex of a range alike, a whole vector at a time: written once with Google Highway, the
// machine's best instruction set chosen at run time, with the same bits on all of them. v and x are 3 x n, one column a
// simulated vertex; f has the columns of the range. Any number of threads may call, at once only for different ranges.
#ifndef PHRENIC_SERVER_MECHANICS_LINALG_VERTEX_KERNEL_H_
#define PHRENIC_SERVER_MECHANICS_LINALG_VERTEX_KERNEL_H_

#include <array>
#include <cstddef>

#include "server/mechanics/parallel/vertex_range.h"
#include "server/mechanics/state.h"
#include "server/mesh/mesh.h"

namespace phrenic {

// A force [N] of which each vertex has a share.
struct SharedLoad {
  const double* share = nullptr;  // one a simulated vertex
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
};
// What pulls at vertices whatever the others do: -c v + sum of share times force, in their order [N].
struct VertexLoads {
  static constexpr size_t kMost = 4;

  const double* c = nullptr;  // a coefficient a simulated vertex [N s/m], where there is one
  std::array<SharedLoad, kMost> shared = {};
  size_t count = 0;

  bool empty() const { return c == nullptr && count == 0; }
};

// f += the loads.
void AddLoads(const VertexRange& range, const VertexLoads& loads, const ConstPoints& v, MutablePoints f);

// v_next = v + kick w (f + loads), then x_next = x + drift v_next, for the vertices with w = 1/m > 0 [1/kg]; the others
// keep v and x. `kick` and `drift` are times [s]. x_next may be x, and v_next v. Returns how far the range then has
// got.
StateBounds KickAndDrift(const VertexRange& range, const Eigen::VectorXd& w, double kick, double drift,
                         const ConstPoints& f, const VertexLoads& loads, const Points& x, const Points& v,
                         Points& x_next, Points& v_next);

// How far the range has got.
StateBounds BoundsOf(const VertexRange& range, const Points& x, const Points& v);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_LINALG_VERTEX_KERNEL_H_
