#include "server/mechanics/solve/translations.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace phrenic {

Translations::Translations(const Model& model) : Translations(LooseParts(model)) {}

Translations::Translations(LooseParts parts) : parts_(parts.count), part_(std::move(parts.of)) {
  parent_.resize(parts_), touches_.assign(parts_, 0);
  std::iota(parent_.begin(), parent_.end(), 0);
  if (parts_ > 0) ground_.assign(part_.size(), Eigen::Matrix3d::Zero());
  matrix_.resize(parts_);
  missing_.resize(parts_), sums_.resize(parts_), whole_.resize(parts_);
}

void Translations::Begin() {
  std::fill(ground_.begin(), ground_.end(), Eigen::Matrix3d::Zero());
  if (!joined_) return;
  std::iota(parent_.begin(), parent_.end(), 0);
  std::fill(touches_.begin(), touches_.end(), 0);
  joined_ = false;
}

int Translations::Root(int part) {
  while (parent_[part] != part) part = parent_[part];
  return part;
}

void Translations::Join(int i, int j) {
  joined_ = true;
  if (part_[i] >= 0 && part_[j] >= 0) {
    const int from = Root(part_[i]), to = Root(part_[j]);
    touches_[to] |= touches_[from];
    parent_[from] = to;
  } else {
    touches_[Root(std::max(part_[i], part_[j]))] = 1;
  }
}

// Adds factor T^T S T to matrix_ and takes factor T^T S y from missing_.
void Translations::AddProducts(double factor, const OuterProducts& products, const Points& y) {
  products.ForEach([&](double scale, const Points& g) {
    std::fill(sums_.begin(), sums_.end(), Eigen::Vector3d::Zero());
    for (int i = 0; i < g.cols(); ++i) {
      if (Free(i)) sums_[Root(part_[i])] += g.col(i);
    }
    const double along = Dot(g, y);
    for (int p = 0; p < parts_; ++p) {
      matrix_[p] += factor * scale * sums_[p] * sums_[p].transpose();
      missing_[p] -= factor * scale * along * sums_[p];
    }
  });
}

void Translations::Correct(const Points& b, const Eigen::VectorXd& inertia, double g, const OuterProducts& outer,
                           const OuterProducts& shared, Points& y) {
  if (empty()) return;
  std::fill(matrix_.begin(), matrix_.end(), Eigen::Matrix3d::Zero());
  std::fill(missing_.begin(), missing_.end(), Eigen::Vector3d::Zero());
  for (int i = 0; i < y.cols(); ++i) {
    if (!Free(i)) continue;
    const int part = Root(part_[i]);
    const Eigen::Matrix3d sum = inertia[i] * Eigen::Matrix3d::Identity() + g * g * ground_[i];
    matrix_[part] += sum;
    missing_[part] += b.col(i) - sum * y.col(i);
  }
  AddProducts(g * g, outer, y);
  AddProducts(g, shared, y);
  for (int p = 0; p < parts_; ++p) {
    sums_[p].setZero();
    if (Root(p) == p && touches_[p] == 0) sums_[p] = matrix_[p].ldlt().solve(missing_[p]);
  }
  for (int i = 0; i < y.cols(); ++i) {
    if (Free(i) && sums_[Root(part_[i])].allFinite()) y.col(i) += sums_[Root(part_[i])];
  }
}

void Translations::Mean(const Eigen::VectorXd& inertia, const Points& v, Points& mean) {
  std::fill(whole_.begin(), whole_.end(), 0.0);
  std::fill(sums_.begin(), sums_.end(), Eigen::Vector3d::Zero());
  for (int i = 0; i < v.cols(); ++i) {
    if (!Free(i)) continue;
    sums_[part_[i]] += inertia[i] * v.col(i);
    whole_[part_[i]] += inertia[i];
  }
  for (int i = 0; i < v.cols(); ++i) {
    mean.col(i).setZero();
    if (Free(i)) mean.col(i) = sums_[part_[i]] / whole_[part_[i]];
  }
}

}  // namespace phrenic
