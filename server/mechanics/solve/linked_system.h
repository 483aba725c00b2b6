// The linear systems of implicit steps with links: A y - E m = b and rate(y) = wanted (LinkEquations), with A that of
// ImplicitSystem plus the stiffness across links under tension.
//
// Projected conjugate gradients (Gould, Hribar, Nocedal, SIAM J Sci Comput 2001;23:1376) with the diagonal blocks D of
// A as preconditioner: every direction keeps the rates, by the factorised E^T D^-1 E. If they need too many iterations,
// a sparse factorisation of A + E R E^T, R large, and the method of multipliers.
#ifndef PHRENIC_SERVER_MECHANICS_SOLVE_LINKED_SYSTEM_H_
#define PHRENIC_SERVER_MECHANICS_SOLVE_LINKED_SYSTEM_H_

#include "server/mechanics/solve/implicit_system.h"
#include "server/mechanics/solve/link_equations.h"

namespace phrenic {

// Not thread-safe. Allocates when it is made, and when it factorises.
class LinkedSystem {
 public:
  explicit LinkedSystem(const Model& model);

  // Sets y and links.change to the solution y and m for links.wanted, with y as first guess, as ImplicitSystem::Solve
  // does. Requires: `system` and the tension of `links` are those of the moment `at`.
  absl::Status Solve(const Model& model, const EvalContext& at, ImplicitSystem& system, LinkEquations& links,
                     const Points& b, double tolerance, SolverEffort& effort, Points& y);

 private:
  void Precondition(const ImplicitSystem& system, LinkEquations& links);
  void Meet(LinkEquations& links, Points& y);
  void Times(ImplicitSystem& system, const LinkEquations& links, bool whole, const Points& p);
  double Descend(LinkEquations& links);
  bool Iterate(ImplicitSystem& system, LinkEquations& links, double tolerance, SolverEffort& effort, Points& y);
  absl::Status SolveDirectly(const Model& model, const EvalContext& at, ImplicitSystem& system, LinkEquations& links,
                             const Points& b, Points& y);

  VertexBlocks inverse_;  // D^-1
  Points residual_, down_, direction_, product_;
  Eigen::VectorXd shift_, stiffness_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SOLVE_LINKED_SYSTEM_H_
