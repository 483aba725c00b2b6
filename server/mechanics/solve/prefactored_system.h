// The constant matrix of projective dynamics: A = M + g C + g^2 L, n x n, the same for the three axes, factorised once.
//
// L stands for the stiffness K at rest and is at least as stiff: x^T K x = sum over pairs of -(x_i - x_j)^T K_ij (x_i -
// x_j) and what is held to the ground, in which each 3 x 3 block is replaced by its largest eigenvalue times the unit
// matrix (0 where that is negative). For springs at rest it is k, and A the matrix of Bouaziz, Martin, Liu, Kavan,
// Pauly (ACM Trans Graph 2014;33:154).
#ifndef PHRENIC_SERVER_MECHANICS_SOLVE_PREFACTORED_SYSTEM_H_
#define PHRENIC_SERVER_MECHANICS_SOLVE_PREFACTORED_SYSTEM_H_

#include <string>
#include <vector>

#include "server/mechanics/linalg/sparse_ldlt.h"
#include "server/mechanics/solve/block_matrix.h"

namespace phrenic {

// A function of model, parameters and g alone, whatever state a run is in: what is restored goes on bit for bit. Not
// thread-safe.
class PrefactoredSystem {
 public:
  explicit PrefactoredSystem(const Model& model);

  // Makes the matrix that of these parameters and g [s]. Does nothing where it is; allocates where it is not.
  void Prepare(const Model& model, const v1::Parameters& parameters, double g);
  // y = A^-1 b, both 3 x n; 0 for fixed and driven vertices. Does not allocate.
  void Solve(const Points& b, Points& y);
  // Of the last Prepare; 0 before.
  double g() const { return g_; }

 private:
  bool IsFor(const v1::Parameters& parameters, double g);
  void Assemble(const Model& model, const EvalContext& at);
  void PrepareShared(const Model& model, const EvalContext& at);
  void SolvePlain(const Points& b, Points& y);

  double g_ = 0;
  std::string key_, asked_;  // the parameters of the present matrix, and those asked for, as bytes
  BlockMatrix stiffness_;
  OuterProducts shared_damping_;
  std::vector<bool> free_;
  std::vector<int> row_;    // of each vertex in the order of elimination
  std::vector<int> place_;  // in values_ of each block right of the diagonal; -1 where an end is not free
  SparseLdlt pattern_;
  SparseLdlt::Factors factors_;
  Eigen::VectorXd diagonal_;    // in the order of elimination
  std::vector<double> values_;  // below the diagonal
  Points right_;                // in the order of elimination
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SOLVE_PREFACTORED_SYSTEM_H_
