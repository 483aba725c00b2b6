// The links of a model as equations of an implicit step: A y - E m = b and rate(y) = c, with y the velocities, m one
// multiplier per link [N s], E m the impulses along the links' present directions u (+u on the first end, -u on the
// second, so that m > 0 pulls), rate = u . (y_b - y_a) = -E^T y [m/s].
//
// Of inequalities (length limits) those act that are violated; one is released if its multiplier has the wrong sign.
// Redundant links get no multiplier.
#ifndef PHRENIC_SERVER_MECHANICS_SOLVE_LINK_EQUATIONS_H_
#define PHRENIC_SERVER_MECHANICS_SOLVE_LINK_EQUATIONS_H_

#include <Eigen/SparseCore>
#include <vector>

#include "server/mechanics/linalg/sparse_ldlt.h"
#include "server/mechanics/model.h"

namespace phrenic {

// One 3 x 3 block per simulated vertex, such as the inverse of a matrix's diagonal; 0 for fixed and driven ones.
using VertexBlocks = std::vector<Eigen::Matrix3d>;

// Sets `blocks` to the inverse masses [1/kg].
void SetInverseMasses(const Model& model, VertexBlocks& blocks);

// Not thread-safe. Allocates when it is made only.
class LinkEquations {
 public:
  explicit LinkEquations(const Model& model);
  // True if the model has no links that it can solve.
  bool empty() const { return links_.empty(); }
  // False if the links are too tangled to be solved together: the object must not be used.
  bool complete() const { return matrix_.complete(); }

  // Forgets all multipliers: equalities act, limits do not.
  void Restart();
  // Sets directions and gaps to those of the positions x, and which limits act.
  void Place(const ConstPoints& x);
  // The same for a motion that begins here: limits act if they are reached and not on the way back.
  void PlaceReached(const State& state);
  // Sets directions and gaps alone.
  void Turn(const ConstPoints& x);
  // Releases limits whose multiplier has the wrong sign. Returns false if there are none.
  bool Release();
  // The largest relative error of a length, of those that act.
  double LargestGap() const;

  // Factorises E^T B E, B the blocks.
  void Factorise(const VertexBlocks& inverse);
  // Sets each to 1/(u^T (B_a + B_b) u), of the last Factorise; 0 for links that do not act.
  void EffectiveMasses(Eigen::VectorXd& masses) const {
    masses = (diagonal_.array() > 0).select(diagonal_.array().inverse(), 0);
  }
  // Replaces `m` by (E^T B E)^-1 m.
  void Solve(Eigen::VectorXd& m) const { matrix_.Solve(factors_, m); }
  // Sets `rates` to those of y; 0 for links that do not act.
  void Rates(const ConstPoints& y, Eigen::VectorXd& rates) const;
  // Adds E m to f, and B E m to y.
  void AddImpulses(const Eigen::VectorXd& m, Points& f) const;
  void AddResponse(const Eigen::VectorXd& m, const VertexBlocks& inverse, Points& y) const;
  // Sets `rates` to those that close the gaps within `seconds`.
  void ClosingRates(double seconds, Eigen::VectorXd& rates) const;
  // Sets `rates` to those of the acceleration that keeps the lengths at velocities v: -|v_b - v_a|^2/length across u.
  void Centripetal(const ConstPoints& v, Eigen::VectorXd& rates) const;

  // Sets the stiffness across each link under tension, g m/length [kg]: a link that pulls turns back as a spring does.
  void SetTension(double g);
  void AddTension(VertexBlocks& diagonal) const;
  void AddTensionTimes(const Points& y, Points& product) const;
  // Adds the tension and `stiffness`_i u u^T [kg] of each link, of the movable ends, to a matrix of scalars.
  void AddEntries(const Eigen::VectorXd& stiffness, std::vector<Eigen::Triplet<double>>& entries) const;

  // Of each link: its multiplier [N s], and room for as many numbers.
  Eigen::VectorXd multipliers, change, wanted, buffer;

 private:
  struct Coupling {
    int at, i, j, vertex;
    double sign;
  };
  void FindCouplings();

  std::vector<Link> links_;
  std::vector<bool> active_;
  int releases_ = 0;  // since Restart
  std::vector<Coupling> couplings_;
  Points directions_;  // unit vectors; 0 if the link does not act
  Eigen::VectorXd lengths_, tension_, diagonal_;
  std::vector<double> values_;
  SparseLdlt matrix_;
  SparseLdlt::Factors factors_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SOLVE_LINK_EQUATIONS_H_
