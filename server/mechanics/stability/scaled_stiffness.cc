#include "server/mechanics/stability/scaled_stiffness.h"

#include <cmath>

#include "server/mechanics/damping.h"

namespace phrenic {

ScaledStiffness::ScaledStiffness(const Model& model, const EvalContext& at, Integrator::Damping counted)
    : blocks_(model, BlockMatrix::Springs::kElsewhere),
      damping_(model.rest.cols()),
      scale_(model.inverse_mass.cwiseSqrt()) {
  if (counted >= Integrator::Damping::kViscosity && HasViscosity(model)) {
    viscosity_ = std::make_unique<BlockMatrix>(model, BlockMatrix::Springs::kElsewhere);
    viscous_.resize(3, model.rest.cols());
    for (const auto& force : model.forces) AddViscosity(*force, at, 1, *viscosity_);
  }
  damping_.setZero();
  if (counted >= Integrator::Damping::kOfEachVertex) SumDamping(model, at, damping_);
  if (counted == Integrator::Damping::kAll) SumSharedDamping(model, at, shared_damping_);
  joints_.reserve(static_cast<size_t>(model.report.springs()));
  for (const auto& force : model.forces) {
    force->AddStiffness(at, *this);
    force->AddLatentStiffness(at, *this);
  }
}

void ScaledStiffness::AddSprings(std::span<const SpringStiffness> springs) {
  for (const auto& [a, b, edge, axial, transverse] : springs) {
    if (scale_[a] == 0 && scale_[b] == 0) continue;
    const double root = std::sqrt(axial);
    joints_.push_back({a, b, {root * edge[0], root * edge[1], root * edge[2]}, transverse});
  }
}

// Joints of one vertex after another, as edges are sorted, add to it in a register, in the same order.
void ScaledStiffness::AddJoints(double* y) const {
  const double* const x = scaled_.data();
  for (auto joint = joints_.begin(); joint != joints_.end();) {
    const int vertex = joint->a;
    const double* const from_a = x + 3 * static_cast<std::ptrdiff_t>(vertex);
    double* const to_a = y + 3 * static_cast<std::ptrdiff_t>(vertex);
    const double from[3] = {from_a[0], from_a[1], from_a[2]};
    double sum[3] = {to_a[0], to_a[1], to_a[2]};
    for (; joint != joints_.end() && joint->a == vertex; ++joint) {
      const double* const from_b = x + 3 * static_cast<std::ptrdiff_t>(joint->b);
      double* const to_b = y + 3 * static_cast<std::ptrdiff_t>(joint->b);
      const double* const along = joint->along;
      const double d[3] = {from[0] - from_b[0], from[1] - from_b[1], from[2] - from_b[2]};
      const double axial = along[0] * d[0] + along[1] * d[1] + along[2] * d[2];
      for (int k = 0; k < 3; ++k) {
        const double force = axial * along[k] + joint->transverse * d[k];
        sum[k] += force;
        to_b[k] -= force;
      }
    }
    for (int k = 0; k < 3; ++k) to_a[k] = sum[k];
  }
}

void ScaledStiffness::Times(const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::VectorXd& y) {
  const Eigen::Index n = scale_.size();
  scaled_.noalias() = Eigen::Map<const Points>(x.data(), 3, n) * scale_.asDiagonal();
  Eigen::Map<Points> product(y.data(), 3, n);
  blocks_.Times(scaled_, product);
  AddJoints(y.data());
  if (damping_weight_ > 0) {
    product += scaled_ * (damping_weight_ * damping_).asDiagonal();
    shared_damping_.AddTimes(damping_weight_, scaled_, product);
    if (viscosity_ != nullptr) {
      viscosity_->Times(scaled_, viscous_);
      product += damping_weight_ * viscous_;
    }
  }
  product *= scale_.asDiagonal();
}

}  // namespace phrenic
