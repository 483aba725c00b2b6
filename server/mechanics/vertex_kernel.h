// What is done to every vertex of a range alike, a whole vector at a time: written once with Google Highway, the
// machine's best instruction set chosen at run time, with the same bits on all of them. v and x are 3 x n, one column a
// simulated vertex; f has the columns of the range. Any number of threads may call, at once only for different ranges.
#ifndef PHRENIC_SERVER_MECHANICS_VERTEX_KERNEL_H_
#define PHRENIC_SERVER_MECHANICS_VERTEX_KERNEL_H_

#include "server/mechanics/state.h"
#include "server/mechanics/vertex_range.h"
#include "server/mesh/mesh.h"

namespace phrenic {

// v_next = v + kick w f, then x_next = x + drift v_next, for the vertices with w = 1/m > 0 [1/kg]; the others keep v
// and x. `kick` and `drift` are times [s]. x_next may be x, and v_next v.
void KickAndDrift(const VertexRange& range, const Eigen::VectorXd& w, double kick, double drift, const ConstPoints& f,
                  const Points& x, const Points& v, Points& x_next, Points& v_next);

// f -= c v, c a coefficient a vertex [N s/m].
void AddFriction(const VertexRange& range, const Eigen::VectorXd& c, const ConstPoints& v, MutablePoints f);

// f += s F, s a share a vertex, F one force for all [N].
void AddShares(const VertexRange& range, const Eigen::VectorXd& s, const Eigen::Vector3d& force, MutablePoints f);

// How far the range has got; sums are taken in the same order by all instruction sets.
StateReach ReachOf(const VertexRange& range, const Points& x, const Points& v);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_VERTEX_KERNEL_H_
