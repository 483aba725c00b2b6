#include "server/mechanics/outer_products.h"

namespace phrenic {
namespace {

double Dot(const ConstPoints& a, const ConstPoints& b) { return a.cwiseProduct(b).sum(); }

}  // namespace

void OuterProducts::Add(double scale, const Points& g) {
  if (used_ == terms_.size()) terms_.emplace_back();
  terms_[used_].scale = scale;
  terms_[used_].g = g;
  ++used_;
}

void OuterProducts::AddTimes(double factor, const ConstPoints& x, MutablePoints y) const {
  for (size_t k = 0; k < used_; ++k) y += factor * terms_[k].scale * Dot(terms_[k].g, x) * terms_[k].g;
}

void OuterProducts::Correct(double factor, absl::FunctionRef<void(const Points&, Points&)> inverse, Points& y) {
  const auto take_off = [&](const Term& term, Points& from) {
    const double scale = factor * term.scale;
    from -= scale * Dot(term.g, from) / (1 + scale * Dot(term.g, term.solved)) * term.solved;
  };
  for (size_t k = 0; k < used_; ++k) {
    Term& term = terms_[k];
    inverse(term.g, term.solved);
    for (size_t j = 0; j < k; ++j) take_off(terms_[j], term.solved);
    take_off(term, y);
  }
}

double OuterProducts::Bound(const Eigen::VectorXd& weights) const {
  double sum = 0;
  for (size_t k = 0; k < used_; ++k) {
    sum += terms_[k].scale * terms_[k].g.colwise().squaredNorm().transpose().cwiseProduct(weights).sum();
  }
  return sum;
}

}  // namespace phrenic
