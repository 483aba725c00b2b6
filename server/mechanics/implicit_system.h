// The linear systems of implicit steps: A y = b with A = M + g C + g^2 K on the free vertices, M the masses, C the
// damping coefficients, K the stiffness and g [s] the step's weight. A is symmetric and positive definite.
#ifndef PHRENIC_SERVER_MECHANICS_IMPLICIT_SYSTEM_H_
#define PHRENIC_SERVER_MECHANICS_IMPLICIT_SYSTEM_H_

#include <Eigen/SparseCholesky>
#include <vector>

#include "absl/status/status.h"
#include "server/mechanics/block_matrix.h"

namespace phrenic {

// Conjugate gradients with the inverse diagonal blocks as preconditioner (Baraff and Witkin 1998, their filter for what
// is fixed); a sparse LDL^T factorisation where they take too many iterations, which they do where stiffnesses differ
// by orders of magnitude. Not thread-safe. Allocates when it is made and when it factorises.
class ImplicitSystem {
 public:
  explicit ImplicitSystem(const Model& model);

  // Takes M, C and K from the model at this instant.
  void Assemble(const Model& model, const Instant& at, double g);
  // y = A^-1 b, to this relative residual; 0 for fixed and driven vertices. ABORTED where b is not finite or
  // the matrix cannot be factorised.
  absl::Status Solve(const Model& model, const Points& b, double tolerance, Points& y);
  // Of the last Solve; 0 where it factorised.
  int iterations() const { return iterations_; }

 private:
  void SolveFactored(const Model& model, const Points& b, Points& y) const;
  void Times(const Model& model, const Points& x, Points& y) const;
  void Precondition(const Points& r, Points& z) const;
  bool ConjugateGradients(const Model& model, const Points& b, double tolerance, Points& y);
  absl::Status Factorise(const Model& model, const Points& b, Points& y);

  BlockMatrix stiffness_;
  OuterProducts shared_damping_;
  double g_ = 0;
  Eigen::VectorXd diagonal_;               // m + g c; 0 for fixed and driven vertices
  std::vector<Eigen::Matrix3d> inverses_;  // of the diagonal blocks
  Points residual_, direction_, product_, scaled_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
  bool factorised_ = false;  // factor_ is that of the present matrix
  int iterations_ = 0;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_IMPLICIT_SYSTEM_H_
