// Matrices of low rank, S = sum of scale g g^T with g of 3 x n, of which only the terms are stored.
#ifndef PHRENIC_SERVER_MECHANICS_LINALG_OUTER_PRODUCTS_H_
#define PHRENIC_SERVER_MECHANICS_LINALG_OUTER_PRODUCTS_H_

#include <vector>

#include "absl/functional/function_ref.h"
#include "server/mechanics/linalg/outer_products_kernel.h"
#include "server/mesh/mesh.h"

namespace phrenic {

// Returns the sum of the products of entries.
inline double Dot(const ConstPoints& a, const ConstPoints& b) { return a.cwiseProduct(b).sum(); }

// Not thread-safe. Allocates only while the number of terms grows.
class OuterProducts {
 public:
  void Clear() { used_ = 0; }
  // Adds a term, unless scale is 0. Requires: scale >= 0.
  void Add(double scale, const Points& g);
  // Adds a term and returns its g, which the caller sets, whatever size and values it has. Requires: scale > 0.
  Points& AddTerm(double scale);
  bool empty() const { return used_ == 0; }
  // Calls change(g) for each term, which may change g.
  template <typename F>
  void Change(F change) {
    for (size_t k = 0; k < used_; ++k) change(terms_[k].g);
  }
  // Calls f(scale, g) for each term.
  template <typename F>
  void ForEach(F f) const {
    for (size_t k = 0; k < used_; ++k) f(terms_[k].scale, terms_[k].g);
  }

  // Adds factor S x to y.
  void AddTimes(double factor, const ConstPoints& x, MutablePoints y) const;
  // Replaces y = B^-1 b by (B + factor S)^-1 b (Sherman and Morrison 1950, term after term). `inverse` sets its second
  // argument to B^-1 times its first.
  void Correct(double factor, absl::FunctionRef<void(const Points&, Points&)> inverse, Points& y);
  // Corrects the end of a step of `dt` [s] that was taken without S from the velocities `start` [m/s]: the gain of `v`
  // becomes (1/W + dt S)^-1 1/W times itself, W the diagonal matrix of `weights` (Woodbury 1950), and x follows it by
  // `dt`.
  void CorrectStep(double dt, const Eigen::VectorXd& weights, const Points& start, Points& v, Points& x);
  // The two halves of Correct, for several right-hand sides: what depends on B alone, and the rest.
  void Prepare(double factor, absl::FunctionRef<void(const Points&, Points&)> inverse);
  void CorrectPrepared(double factor, Points& y) const;
  // Returns an upper bound of the largest eigenvalue of W S, W the diagonal matrix of `weights`; exact for one term.
  double Bound(const Eigen::VectorXd& weights) const;

 private:
  struct Term {
    double scale;
    Points g, solved;
  };
  static void TakeOff(const Term& term, double factor, Points& y);

  std::vector<Term> terms_;
  size_t used_ = 0;
  // Of CorrectStep.
  WeightedTerms weighted_;
  std::vector<double> lanes_;
  Eigen::MatrixXd gram_;
  Eigen::VectorXd along_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_LINALG_OUTER_PRODUCTS_H_
