#include "server/mechanics/solve/quasi_newton.h"

#include "server/mechanics/linalg/outer_products.h"

namespace phrenic {
namespace {

constexpr double kNoFall = 1e-12;  // of the product of the lengths: a smaller decrease counts as none

}  // namespace

void QuasiNewton::Restart(int vertices, int most) {
  used_ = 0;
  right_.resize(3, vertices);
  shares_.resize(most);
  pairs_.resize(most);
  for (Pair& pair : pairs_) {
    pair.step.resize(3, vertices);
    pair.fall.resize(3, vertices);
  }
}

void QuasiNewton::Note(const Points& step, const Points& before, const Points& after) {
  if (used_ == pairs_.size()) return;
  Pair& pair = pairs_[used_];
  pair.step = step;
  pair.fall = before - after;
  pair.along = Dot(pair.step, pair.fall);
  if (pair.along > kNoFall * pair.step.norm() * pair.fall.norm()) ++used_;
}

void QuasiNewton::Times(const Points& r, PrefactoredSystem& a, Points& y) {
  right_ = r;
  for (size_t k = used_; k-- > 0;) {
    const Pair& pair = pairs_[k];
    shares_[k] = Dot(pair.step, right_) / pair.along;
    right_ -= shares_[k] * pair.fall;
  }
  a.Solve(right_, y);
  for (size_t k = 0; k < used_; ++k) {
    const Pair& pair = pairs_[k];
    y += (shares_[k] - Dot(pair.fall, y) / pair.along) * pair.step;
  }
}

}  // namespace phrenic
