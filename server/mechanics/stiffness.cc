#include "server/mechanics/stiffness.h"

#include <array>

#include "server/mechanics/eval_context.h"

namespace phrenic {
namespace {

// Springs whose stiffness is worked out and handed over at a time.
class StiffnessBatch {
 public:
  StiffnessBatch() {
    for (Column* column : {&squared_, &rest_length_, &stiffness_}) column->setOnes();
  }
  // One without length is left out.
  void Add(const Spring& spring, double stiffness, const Eigen::Vector3d& edge) {
    const auto place = static_cast<Eigen::Index>(count_);
    const double squared = edge[0] * edge[0] + edge[1] * edge[1] + edge[2] * edge[2];
    if (squared == 0) return;
    springs_[count_].a = spring.a, springs_[count_].b = spring.b;
    springs_[count_++].edge = edge;
    squared_[place] = squared, rest_length_[place] = spring.rest_length, stiffness_[place] = stiffness;
  }
  bool full() const { return count_ == kMost; }
  void HandOver(StiffnessSink& sink) {
    const Column per_length = squared_.sqrt().inverse();
    const Column transverse = stiffness_ * (1 - rest_length_ * per_length).max(0);
    const Column axial = (stiffness_ - transverse) * per_length * per_length;
    for (size_t s = 0; s < count_; ++s) {
      springs_[s].axial = axial[static_cast<Eigen::Index>(s)];
      springs_[s].transverse = transverse[static_cast<Eigen::Index>(s)];
    }
    sink.AddSprings({springs_.data(), count_});
    count_ = 0;
  }

 private:
  static constexpr int kMost = 64;
  using Column = Eigen::Array<double, kMost, 1>;
  std::array<SpringStiffness, kMost> springs_;
  Column squared_, rest_length_, stiffness_;
  size_t count_ = 0;
};

}  // namespace

void StiffnessSink::AddSpringsAt(std::span<const Spring> springs, const EvalContext& at) {
  const double elasticity = at.parameters.elasticity();
  const double* const x = at.x.data();
  StiffnessBatch batch;
  for (const Spring& spring : springs) {
    const double* const a = x + 3 * static_cast<std::ptrdiff_t>(spring.a);
    const double* const b = x + 3 * static_cast<std::ptrdiff_t>(spring.b);
    batch.Add(spring, elasticity * spring.stiffness, {b[0] - a[0], b[1] - a[1], b[2] - a[2]});
    if (batch.full()) batch.HandOver(*this);
  }
  batch.HandOver(*this);
}

}  // namespace phrenic
