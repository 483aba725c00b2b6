// The linear systems of implicit steps: A y = b with A = M + g C + g^2 K on the free vertices, M the masses, C the
// damping coefficients, K the stiffness and g [s] the step's weight. A is symmetric and positive definite.
#ifndef PHRENIC_SERVER_MECHANICS_SOLVE_IMPLICIT_SYSTEM_H_
#define PHRENIC_SERVER_MECHANICS_SOLVE_IMPLICIT_SYSTEM_H_

#include <Eigen/SparseCholesky>
#include <memory>

#include "absl/status/status.h"
#include "server/mechanics/solve/block_matrix.h"
#include "server/mechanics/solve/block_rows.h"
#include "server/mechanics/solver_effort.h"

namespace phrenic {

// Conjugate gradients with the inverse diagonal blocks as preconditioner (Baraff and Witkin 1998, their filter for what
// is fixed); a sparse LDL^T factorisation where they take too many iterations, which they do where stiffnesses differ
// by orders of magnitude. The iterations are taken in single precision for what is missing to a first guess, which is
// worked out in double: y is right to 1e-6 of that, so that a relative residual below kFinest is not to be had from
// them. Not thread-safe. Allocates when it is made and when it factorises.
class ImplicitSystem {
 public:
  static constexpr double kFinest = 1e-6;

  explicit ImplicitSystem(const Model& model);

  // Takes M, C and K from the model at this instant.
  void Assemble(const Model& model, const EvalContext& at, double g);
  // y becomes A^-1 b, from what it is as a first guess, until what is missing, in the preconditioner's norm, is
  // `tolerance` of what it was, or kFinest of b; 0 for fixed and driven vertices. At the instant of Assemble. Where the
  // effort is spent y is the best there is by then, after one iteration at least; it notes what was reached. ABORTED
  // where b is not finite or the matrix cannot be factorised.
  absl::Status Solve(const Model& model, const EvalContext& at, const Points& b, double tolerance, SolverEffort& effort,
                     Points& y);

 private:
  enum class End { kSolved, kSpent, kTooLong };
  struct Progress {
    double first = 0, enough = 0, now = 0;  // squared norms of what is missing: at first, in the end, and now
    int iterations = 0;
  };
  double StartFrom(const Points& b, Points& y);
  void Begin(double tolerance, Progress& progress);
  End Iterate(const SolverEffort& effort, Progress& progress);
  absl::Status Factorise(const Model& model, const EvalContext& at, const Points& b, Points& y);
  void SolveFactored(const Points& b, Points& y) const;

  BlockRows rows_;
  double g_ = 0;
  Eigen::VectorXd inertia_;  // m + g c; 0 for fixed and driven vertices
  Points missing_;           // to the first guess, K left out
  double floor_ = 0;         // kFinest of b, squared, in the unit of residual_
  RowVector change_, residual_, product_;
  // Where a factorisation is needed; made when first needed.
  std::unique_ptr<BlockMatrix> stiffness_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
  bool factorised_ = false;  // factor_ is that of the present matrix
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SOLVE_IMPLICIT_SYSTEM_H_
