// The translations of parts that nothing holds (LooseParts).
//
// Internal forces sum to zero, so that a step changes a free part's momentum by external forces alone. An iterative
// solver leaves a residual with a sum of its own, which a free part gains as momentum in every step. Correct adds to a
// solution the translations of the parts that make the sum of the residual over each part zero (a Galerkin correction
// with these translations as coarse space: it never enlarges the error in the norm of A). Momentum is then kept to
// rounding.
#ifndef PHRENIC_SERVER_MECHANICS_SOLVE_TRANSLATIONS_H_
#define PHRENIC_SERVER_MECHANICS_SOLVE_TRANSLATIONS_H_

#include <vector>

#include "server/mechanics/linalg/outer_products.h"
#include "server/mechanics/model.h"
#include "server/mechanics/step/loose_parts.h"

namespace phrenic {

// Not thread-safe. Allocates when it is made only.
class Translations {
 public:
  explicit Translations(const Model& model);
  // True if every part is held.
  bool empty() const { return parts_ == 0; }
  // True if the vertex belongs to a part that nothing holds.
  bool Free(int vertex) const { return part_[vertex] >= 0; }

  // The stiffness of the present moment: Begin, then Add for every block K_ij between vertices that move.
  void Begin();
  void Add(int i, int j, const Eigen::Matrix3d& block) {
    if (Free(j)) ground_[j] += block;
    if (part_[i] != part_[j]) Join(i, j);
  }

  // Corrects the solution y of A y = b, A = diag(inertia) + g^2 (K + outer) + g shared.
  void Correct(const Points& b, const Eigen::VectorXd& inertia, double g, const OuterProducts& outer,
               const OuterProducts& shared, Points& y);
  // The mean of v over each free part, weighted by `inertia`; 0 for other vertices.
  void Mean(const Eigen::VectorXd& inertia, const Points& v, Points& mean);

 private:
  explicit Translations(LooseParts parts);
  void Join(int i, int j);
  int Root(int part);
  void AddProducts(double factor, const OuterProducts& products, const Points& y);

  int parts_ = 0;
  std::vector<int> part_;                // of each vertex; -1 if it is held or does not move
  std::vector<int> parent_;              // of each part: joined parts count as one
  std::vector<Eigen::Matrix3d> ground_;  // of each vertex: the sum of K's column
  std::vector<Eigen::Matrix3d> matrix_;  // of each part: T^T A T
  std::vector<Eigen::Vector3d> missing_, sums_;
  std::vector<double> whole_;  // mass of each part, for Mean
  std::vector<char> touches_;  // of each joined part: it is coupled to what is held at this moment
  bool joined_ = false;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SOLVE_TRANSLATIONS_H_
