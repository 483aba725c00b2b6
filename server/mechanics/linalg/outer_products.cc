#include "server/mechanics/linalg/outer_products.h"

#include <Eigen/Cholesky>
#include <utility>

namespace phrenic {

void OuterProducts::Add(double scale, const Points& g) {
  if (scale != 0) AddTerm(scale) = g;
}

Points& OuterProducts::AddTerm(double scale) {
  if (used_ == terms_.size()) terms_.emplace_back();
  terms_[used_].scale = scale;
  return terms_[used_++].g;
}

void OuterProducts::AddTimes(double factor, const ConstPoints& x, MutablePoints y) const {
  for (size_t k = 0; k < used_; ++k) y += factor * terms_[k].scale * Dot(terms_[k].g, x) * terms_[k].g;
}

void OuterProducts::TakeOff(const Term& term, double factor, Points& y) {
  const double scale = factor * term.scale;
  y -= scale * Dot(term.g, y) / (1 + scale * Dot(term.g, term.solved)) * term.solved;
}

void OuterProducts::Prepare(double factor, absl::FunctionRef<void(const Points&, Points&)> inverse) {
  for (size_t k = 0; k < used_; ++k) {
    inverse(terms_[k].g, terms_[k].solved);
    for (size_t j = 0; j < k; ++j) TakeOff(terms_[j], factor, terms_[k].solved);
  }
}

void OuterProducts::CorrectPrepared(double factor, Points& y) const {
  for (size_t k = 0; k < used_; ++k) TakeOff(terms_[k], factor, y);
}

void OuterProducts::Correct(double factor, absl::FunctionRef<void(const Points&, Points&)> inverse, Points& y) {
  Prepare(factor, inverse);
  CorrectPrepared(factor, y);
}

// (B + G D G^T)^-1 B gain = gain - W G (D^-1 + G^T W G)^-1 G^T gain with D = dt times the scales and W = B^-1.
void OuterProducts::CorrectStep(double dt, const Eigen::VectorXd& weights, const Points& start, Points& v, Points& x) {
  const auto terms = static_cast<Eigen::Index>(used_);
  weighted_ = {.g = std::move(weighted_.g), .weights = weights.data(), .columns = static_cast<size_t>(v.cols())};
  weighted_.g.clear();
  for (size_t k = 0; k < used_; ++k) weighted_.g.push_back(terms_[k].g.data());
  gram_.resize(terms, terms);
  along_.resize(terms);
  // The lower triangle row by row is the upper one of Eigen's columns.
  SumProducts(weighted_, start.data(), v.data(), lanes_, along_.data(), gram_.data());
  for (Eigen::Index k = 0; k < terms; ++k) gram_(k, k) += 1 / (dt * terms_[static_cast<size_t>(k)].scale);
  Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>, Eigen::Upper>(gram_).solveInPlace(along_);
  TakeOffTerms(weighted_, along_.data(), dt, v.data(), x.data());
}

double OuterProducts::Bound(const Eigen::VectorXd& weights) const {
  double sum = 0;
  for (size_t k = 0; k < used_; ++k) {
    sum += terms_[k].scale * terms_[k].g.colwise().squaredNorm().transpose().cwiseProduct(weights).sum();
  }
  return sum;
}

}  // namespace phrenic
