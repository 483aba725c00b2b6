// Links that share vertices (chains, trusses, grids), solved simultaneously.
//
// Positions: the multipliers lambda [kg m] along the links' unit directions r at the start of the step solve
//   J M^-1 J^T lambda = errors [m],
// J the constraint Jacobian (one row per link, from the directions), M the masses. The sparse matrix is factorised once
// per step and reused until every relative length error is below 1e-10: a chord Newton method, which multiplies the
// error by about the links' rotation per step [rad] in each iteration. Velocities: the same system with the current
// directions (RATTLE).
// If an iteration does not halve the error (large rotations in one step), Newton iterations with the current directions
// follow, with up to 20 factorisations. If they fail too (incompatible links), up to 200 Gauss-Seidel sweeps restore
// one link after another; the remaining error is the residual. Redundant links get no multiplier. Limits (inequality
// links) form an active set: violated ones are added, those whose multiplier would push a cable or pull a strut are
// released, in up to 30 rounds. Hess et al., LINCS, J Comput Chem 1997;18:1463; Andersen, RATTLE, J Comput Phys
// 1983;52:24.
#ifndef PHRENIC_SERVER_MECHANICS_CONSTRAINTS_LINK_NETWORK_H_
#define PHRENIC_SERVER_MECHANICS_CONSTRAINTS_LINK_NETWORK_H_

#include <vector>

#include "server/mechanics/constraints/link.h"
#include "server/mechanics/linalg/sparse_ldlt.h"

namespace phrenic {

// Immutable and thread-safe, for threads with scratch memory of their own. Allocates if this is the largest network
// that used that memory so far.
class LinkNetwork {
 public:
  LinkNetwork() = default;
  // A network that would take more than some hundred megabytes to solve is not complete() and must not be used: links
  // that share one vertex couple in pairs, and the factors of tangled networks fill.
  explicit LinkNetwork(const std::vector<Link>& links);
  bool complete() const { return complete_; }

  // Moves the positions of `state` onto the constraints and changes the velocities by displacement/dt. `before` are the
  // positions at the start of the step, 3 x n [m].
  void Project(const ConstPoints& before, double dt, const Scratch& scratch, State& state) const;
  // Removes the velocity components that change a link's length, or violate a limit that is reached.
  void ProjectVelocities(const Scratch& scratch, State& state) const;
  const std::vector<Link>& links() const { return links_; }

 private:
  // An off-diagonal term: two links with a common vertex.
  struct Coupling {
    int at;         // index into the matrix's values
    int i, j;       // links
    double factor;  // 1/m of the vertex [1/kg]; negative if one link starts and the other ends there
  };
  struct Memory;
  Memory& Fit(const Scratch& scratch) const;  // returns the scratch memory, resized if it is too small

  void FindCouplings();
  void Factorise(const ConstPoints& x, Memory& memory) const;
  double Errors(const State& state,
                Memory& memory) const;  // sets memory.multipliers [m]; returns the largest relative error
  double Rates(const State& state, Memory& memory) const;  // sets memory.multipliers [m/s]; returns the largest rate
  double LargestMove(const Memory& memory) const;
  void ApplyPositionImpulses(double sign, double dt, Memory& memory, State& state) const;
  void ApplyVelocityImpulses(Memory& memory, State& state) const;  // velocities only
  bool Correct(double dt, Memory& memory, State& state, double& error) const;
  void Newton(const ConstPoints& before, double dt, Memory& memory, State& state) const;
  bool UpdateActiveSet(double dt, Memory& memory, State& state) const;  // true if the active set changed
  bool UpdateActiveSetOfVelocities(double slow, Memory& memory, State& state) const;
  double LargestViolation(const State& state) const;

  bool complete_ = true;
  std::vector<Link> links_;
  std::vector<Coupling> couplings_;
  SparseLdlt matrix_;
  size_t values_ = 0;  // number of entries below the matrix's diagonal
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_CONSTRAINTS_LINK_NETWORK_H_
