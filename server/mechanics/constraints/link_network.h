// Links that share vertices (chains, trusses, grids), solved together. The pulls lambda [kg m] along the links' unit
// directions r at the start of the step solve J M^-1 J^T lambda = errors, J the links' directions: sparse, one row a
// link, factorised once a step and used again until every length is within 1e-10 of its own (a chord Newton method,
// whose error falls to about the turn of the links in one step [rad] of itself each time). Velocities have the same
// system with the directions of the moment. Where that stops halving the error (links that turn far in one step) the
// directions of the moment take over, factorised anew each time, 20 times at most; and where that fails too (links that
// cannot all hold) link after link is restored, 200 times at most: what then is left over is the residual. Redundant
// links are left to the others. Limits (links that must not be longer, or not shorter) take part while they hold
// something: those that are violated join, those that would have to push a cable or pull a strut are let go, 30 rounds
// at most. (Hess et al., LINCS, J Comput Chem 1997;18:1463; Andersen, RATTLE, J Comput Phys 1983;52:24.)
#ifndef PHRENIC_SERVER_MECHANICS_CONSTRAINTS_LINK_NETWORK_H_
#define PHRENIC_SERVER_MECHANICS_CONSTRAINTS_LINK_NETWORK_H_

#include <vector>

#include "server/mechanics/constraints/link.h"
#include "server/mechanics/linalg/sparse_ldlt.h"

namespace phrenic {

// Immutable; any number of threads may call, each with scratch memory of its own. Allocates if no network that used
// that memory before was as large.
class LinkNetwork {
 public:
  LinkNetwork() = default;
  explicit LinkNetwork(const std::vector<Link>& links);

  // Positions of `state` get onto the links, velocities change by the same over dt.
  void Project(const ConstPoints& before, double dt, const Scratch& scratch, State& state) const;
  // Velocities keep nothing that would stretch a link.
  void ProjectVelocities(const Scratch& scratch, State& state) const;
  const std::vector<Link>& links() const { return links_; }

 private:
  // Two links with an end in one vertex.
  struct Coupling {
    int at;         // place in the matrix's values
    int i, j;       // links
    double factor;  // 1/m of the vertex [1/kg]; negative where one link starts and the other ends there
  };
  struct Memory;
  Memory& Fit(const Scratch& scratch) const;  // large enough

  void FindCouplings();
  void Factorise(const ConstPoints& x, Memory& memory) const;
  double Errors(const State& state, Memory& memory) const;  // the largest, relative; all of them to memory.pulls
  double Rates(const State& state, Memory& memory) const;   // the same of the velocities [m/s]
  double LargestMove(const Memory& memory) const;
  void PullAll(double sign, double dt, Memory& memory, State& state) const;
  void PushAll(Memory& memory, State& state) const;  // velocities alone
  bool Correct(double dt, Memory& memory, State& state, double& error) const;
  void Newton(const ConstPoints& before, double dt, Memory& memory, State& state) const;
  bool Switch(double dt, Memory& memory, State& state) const;  // true where any limit took hold or let go
  bool SwitchVelocities(double slow, Memory& memory, State& state) const;
  double LargestViolation(const State& state) const;

  std::vector<Link> links_;
  std::vector<Coupling> couplings_;
  SparseLdlt matrix_;
  size_t values_ = 0;  // below the matrix's diagonal
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_CONSTRAINTS_LINK_NETWORK_H_
