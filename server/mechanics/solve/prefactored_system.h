// The constant matrix of projective dynamics: A = M + g C + g^2 L, n x n, the same for the three axes, factorised once.
//
// L replaces the stiffness K at rest and is at least as stiff: in x^T K x = sum over pairs of -(x_i - x_j)^T K_ij (x_i
// - x_j) and the stiffness to ground, each 3 x 3 block is replaced by its largest eigenvalue, at least 0, times the
// unit matrix. For springs at rest it is k, and A is the matrix of Bouaziz, Martin, Liu, Kavan, Pauly (ACM Trans Graph
// 2014;33:154).
#ifndef PHRENIC_SERVER_MECHANICS_SOLVE_PREFACTORED_SYSTEM_H_
#define PHRENIC_SERVER_MECHANICS_SOLVE_PREFACTORED_SYSTEM_H_

#include <string>
#include <vector>

#include "server/mechanics/linalg/sparse_ldlt.h"
#include "server/mechanics/solve/block_matrix.h"
#include "server/mechanics/solve/translations.h"

namespace phrenic {

// Depends on model, parameters and g alone, not on the state: a restored run continues bit for bit. Not thread-safe.
class PrefactoredSystem {
 public:
  explicit PrefactoredSystem(const Model& model);

  // Sets the matrix to that of these parameters and g [s]. Allocates, unless it is that already.
  void Prepare(const Model& model, const v1::Parameters& parameters, double g);
  // Sets y = A^-1 b, both 3 x n; 0 for fixed and driven vertices. Does not allocate.
  void Solve(const Points& b, Points& y);
  // Changes v so that the residual r [N s] of v has no sum over any part that nothing holds and no force ties to a
  // place (Translations).
  void KeepSums(const Points& r, Points& v);
  // True if there is no such part.
  bool AllHeld() const { return translations_.empty(); }
  // Sets `mean` to the mean velocity of each such part, 0 elsewhere.
  void MeanVelocity(const Points& v, Points& mean) { translations_.Mean(inertia_, v, mean); }
  // Returns g of the last Prepare; 0 before the first.
  double g() const { return g_; }

 private:
  bool IsFor(const v1::Parameters& parameters, double g);
  void Assemble(const Model& model, const EvalContext& at);
  void PrepareShared(const Model& model, const EvalContext& at);
  void SolvePlain(const Points& b, Points& y);

  double g_ = 0;
  Translations translations_;
  Eigen::VectorXd inertia_;  // m + g c
  std::string key_, asked_;  // the parameters of the present matrix, and those requested, serialised
  BlockMatrix stiffness_;
  OuterProducts shared_damping_;
  std::vector<bool> free_;
  std::vector<int> row_;    // of each vertex in the order of elimination
  std::vector<int> place_;  // index into values_ of each block right of the diagonal; -1 if an end is not free
  SparseLdlt pattern_;
  SparseLdlt::Factors factors_;
  Eigen::VectorXd diagonal_;    // in the order of elimination
  std::vector<double> values_;  // below the diagonal
  Points right_;                // in the order of elimination
  Points shift_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SOLVE_PREFACTORED_SYSTEM_H_
