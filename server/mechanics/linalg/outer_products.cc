#include "server/mechanics/linalg/outer_products.h"

#include <Eigen/Cholesky>

namespace phrenic {
void OuterProducts::Add(double scale, const Points& g) {
  if (scale == 0) return;
  if (used_ == terms_.size()) terms_.emplace_back();
  terms_[used_].scale = scale;
  terms_[used_].g = g;
  ++used_;
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

// (B + G D G^T)^-1 b = y - W G (D^-1 + G^T W G)^-1 G^T y with D = factor times the scales and W = B^-1.
void OuterProducts::CorrectDiagonal(double factor, const Eigen::VectorXd& weights, Points& y) {
  const auto terms = static_cast<Eigen::Index>(used_);
  gram_.resize(terms, terms);
  along_.resize(terms);
  for (Eigen::Index a = 0; a < terms; ++a) {
    const Points& g = terms_[static_cast<size_t>(a)].g;
    along_[a] = Dot(g, y);
    for (Eigen::Index b = 0; b <= a; ++b) {
      const Points& other = terms_[static_cast<size_t>(b)].g;
      gram_(a, b) = gram_(b, a) = g.cwiseProduct(other).colwise().sum().dot(weights);
    }
    gram_(a, a) += 1 / (factor * terms_[static_cast<size_t>(a)].scale);
  }
  Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>>(gram_).solveInPlace(along_);
  for (Eigen::Index a = 0; a < terms; ++a) {
    y.noalias() -= terms_[static_cast<size_t>(a)].g * (along_[a] * weights).asDiagonal();
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
