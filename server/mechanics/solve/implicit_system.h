// The linear systems of implicit steps: A y = b with A = M + g C + g^2 K on the free vertices, M the masses, C the
// damping (coefficients and viscosity), K the stiffness and g [s] the step's weight. A is symmetric and positive
// definite.
#ifndef PHRENIC_SERVER_MECHANICS_SOLVE_IMPLICIT_SYSTEM_H_
#define PHRENIC_SERVER_MECHANICS_SOLVE_IMPLICIT_SYSTEM_H_

#include <Eigen/SparseCore>
#include <memory>
#include <vector>

#include "absl/status/status.h"
#include "server/mechanics/linalg/sparse_ldlt.h"
#include "server/mechanics/solve/block_matrix.h"
#include "server/mechanics/solve/block_rows.h"
#include "server/mechanics/solver_effort.h"

namespace phrenic {

// Conjugate gradients, preconditioned by the inverse diagonal blocks (Baraff and Witkin 1998, with their filter for
// fixed vertices). A sparse factorisation takes over if they need too many iterations, as they do if stiffnesses differ
// by orders of magnitude. The iterations run in single precision on the residual of the first guess, which is computed
// in double: y is accurate to 1e-6 of that, so that no relative residual below kFinest can be reached. The sum of the
// residual over each part that nothing holds is zero to rounding (Translations). Not thread-safe. Allocates when it is
// made and when it factorises.
class ImplicitSystem {
 public:
  static constexpr double kFinest = 1e-6;

  explicit ImplicitSystem(const Model& model);

  // Sets A from the model at this moment.
  void Assemble(const Model& model, const EvalContext& at, double g);
  // Sets y = A^-1 b, with y as first guess, to a residual in the preconditioner's norm of `tolerance` of the first one,
  // or of kFinest of b; 0 for fixed and driven vertices. Requires: `at` is the moment of Assemble. If the effort's
  // limit is reached, y is the result of the iterations so far, at least one. Adds the solve to `effort`. ABORTED if b
  // is not finite or the matrix cannot be factorised.
  absl::Status Solve(const Model& model, const EvalContext& at, const Points& b, double tolerance, SolverEffort& effort,
                     Points& y);

  // For LinkedSystem, which adds links to the system.
  //
  // Sets q = A p on the free vertices, 0 on others, in single precision; without the diagonal inertia() of A if not
  // `whole`.
  void Times(bool whole, const Points& p, Points& q);
  const Eigen::VectorXd& inertia() const { return inertia_; }
  Eigen::Matrix3d Diagonal(int vertex) const { return rows_.Diagonal(vertex); }
  // Corrects y as Solve does.
  void KeepSums(const Points& b, Points& y) { rows_.KeepSums(b, inertia_, y); }
  // Factorises A plus these entries [kg] on the free vertices, and sets y to the inverse of that times b.
  absl::Status FactoriseWith(const Model& model, const EvalContext& at,
                             const std::vector<Eigen::Triplet<double>>& entries);
  void SolveWith(const Points& b, Points& y);

 private:
  enum class End { kSolved, kSpent, kTooLong };
  struct Progress {
    double first = 0, enough = 0, now = 0;  // squared norms of the residual: at first, to be reached, and now
    int iterations = 0;
  };
  double StartFrom(const Points& b, Points& y);
  void Begin(double tolerance, Progress& progress);
  End Iterate(const SolverEffort& effort, Progress& progress);
  absl::Status SolveDirectly(const Model& model, const EvalContext& at, const Points& b, Points& y);
  void SolveFactored(const Points& b, Points& y) const;

  BlockRows rows_;
  double g_ = 0;
  Eigen::VectorXd inertia_;  // m + g c; 0 for fixed and driven vertices
  Points missing_;           // residual of the first guess, without K
  double floor_ = 0;         // kFinest of b, squared, in the unit of residual_
  RowVector change_, residual_, product_;
  // Of factorisations; made when first needed.
  std::unique_ptr<BlockMatrix> stiffness_;
  OrderedLdlt factor_;
  bool factorised_ = false;  // factor_ is that of the present matrix
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SOLVE_IMPLICIT_SYSTEM_H_
