// What is done to every vertex of a range alike, a whole vector at a time: written once with Google Highway, the
// machine's best instruction set chosen at run time, with the same bits on all of them. v and x are 3 x n, one column a
// simulated vertex; f has the columns of the range. Any number of threads may call, at once only for different ranges.
#ifndef PHRENIC_SERVER_MECHANICS_VERTEX_KERNEL_H_
#define PHRENIC_SERVER_MECHANICS_VERTEX_KERNEL_H_

#include <cstddef>
#include <span>

#include "server/mechanics/state.h"
#include "server/mechanics/vertex_range.h"
#include "server/mesh/mesh.h"

namespace phrenic {

// v_next = v + kick w f, then x_next = x + drift v_next, for the vertices with w = 1/m > 0 [1/kg]; the others keep v
// and x. `kick` and `drift` are times [s]. x_next may be x, and v_next v.
void KickAndDrift(const VertexRange& range, const Eigen::VectorXd& w, double kick, double drift, const ConstPoints& f,
                  const Points& x, const Points& v, Points& x_next, Points& v_next);

// A force [N] of which each vertex has a share.
struct SharedLoad {
  const double* share;  // one a simulated vertex
  Eigen::Vector3d force;
};
inline constexpr size_t kMostLoads = 4;

// f -= c v, c a coefficient a vertex [N s/m], where one is given; then f += share force for each of the loads,
// kMostLoads at most, in their order.
void AddLoads(const VertexRange& range, const Eigen::VectorXd* c, const ConstPoints& v,
              std::span<const SharedLoad> loads, MutablePoints f);

// How far the range has got; sums are taken in the same order by all instruction sets.
StateReach ReachOf(const VertexRange& range, const Points& x, const Points& v);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_VERTEX_KERNEL_H_
