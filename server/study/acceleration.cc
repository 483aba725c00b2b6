#include "server/study/acceleration.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "absl/strings/str_cat.h"
#include "server/mechanics/step/step_plan.h"

namespace phrenic::study {
namespace {

constexpr double kTravel = 2e-6;  // of the fastest vertex within the central difference, in sizes of the scene

}  // namespace

Acceleration::Acceleration(const Subject& subject) : subject_(subject), state_(subject.model->InitialState()) {
  const Model& model = *subject_.model;
  for (int i = 0; i < model.rest.cols(); ++i) {
    if (model.inverse_mass[i] > 0) free_.push_back(i);
  }
  force_ = later_ = earlier_ = Points::Zero(3, model.rest.cols());
  FindScalars();
  ahead_ = state_;
}

// A force sets the rates of those that it integrates.
void Acceleration::FindScalars() {
  rates_ = Eigen::VectorXd::Constant(state_.scalars.q.size(), std::numeric_limits<double>::quiet_NaN());
  subject_.model->plan->SetScalarRates(MakeEvalContext(*subject_.model, subject_.parameters, state_, scratch_), rates_);
  for (int i = 0; i < static_cast<int>(rates_.size()); ++i) {
    if (!std::isnan(rates_[i])) scalars_.push_back(i);
  }
}

absl::StatusOr<Acceleration> Acceleration::Make(const Subject& subject) {
  for (const auto& constraint : subject.model->constraints) {
    if (!constraint->smooth()) {
      return absl::UnimplementedError(
          absl::StrCat("constraint ", constraint->name(),
                       " is not smooth (limits, or the thesis' projection of links), so no ODE solver can "
                       "solve it; remove it from the scene, or set its projection to PROJECTION_EXACT"));
    }
  }
  return Acceleration(subject);
}

const State& Acceleration::SetState(double time, const ConstPoints& x, const ConstPoints& v,
                                    const Eigen::Ref<const Eigen::VectorXd>& q) {
  const Model& model = *subject_.model;
  state_.time = time;
  state_.phase = time / subject_.parameters.breath_length();
  for (size_t i = 0; i < free_.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    state_.x.col(free_[i]) = model.rest.col(free_[i]) + x.col(k);
    state_.v.col(free_[i]) = v.col(k);
  }
  for (size_t i = 0; i < scalars_.size(); ++i) state_.scalars.q[scalars_[i]] = q[static_cast<Eigen::Index>(i)];
  model.plan->DriveMotions(subject_.parameters, 0, scratch_, state_);
  model.plan->AdvanceScalars(subject_.parameters, 0, scratch_, state_);
  return state_;
}

void Acceleration::Unconstrained(MutablePoints a, Eigen::Ref<Eigen::VectorXd> rates) {
  const Model& model = *subject_.model;
  const EvalContext at = MakeEvalContext(model, subject_.parameters, state_, scratch_);
  model.plan->SumForces(at, force_);
  model.plan->SetScalarRates(at, rates_);
  for (size_t i = 0; i < scalars_.size(); ++i) rates[static_cast<Eigen::Index>(i)] = rates_[scalars_[i]];
  for (size_t i = 0; i < free_.size(); ++i) {
    a.col(static_cast<Eigen::Index>(i)) = model.inverse_mass[free_[i]] * force_.col(free_[i]);
  }
}

void Acceleration::ProjectedVelocities(double ahead, const ConstPoints& a, Points& v) {
  const Model& model = *subject_.model;
  ahead_.time = state_.time;
  ahead_.phase = state_.phase;
  ahead_.x = state_.x;
  ahead_.v = state_.v;
  ahead_.poses = state_.poses;
  ahead_.scalars = state_.scalars;
  model.plan->DriveMotions(subject_.parameters, ahead, scratch_, ahead_);
  for (size_t i = 0; i < free_.size(); ++i) {
    ahead_.x.col(free_[i]) += ahead * state_.v.col(free_[i]);
    ahead_.v.col(free_[i]) += ahead * a.col(static_cast<Eigen::Index>(i));
  }
  model.plan->ProjectVelocities(subject_.parameters, scratch_, ahead_);
  v = ahead_.v;
}

void Acceleration::Evaluate(MutablePoints a, Eigen::Ref<Eigen::VectorXd> rates) {
  Unconstrained(a, rates);
  if (subject_.model->constraints.empty()) return;
  const double fastest = std::max(1.0, state_.v.cwiseAbs().maxCoeff() / subject_.model->size);
  const double ahead = kTravel / fastest;
  ProjectedVelocities(ahead, a, later_);
  ProjectedVelocities(-ahead, a, earlier_);
  for (size_t i = 0; i < free_.size(); ++i) {
    a.col(static_cast<Eigen::Index>(i)) = (later_.col(free_[i]) - earlier_.col(free_[i])) / (2 * ahead);
  }
}

}  // namespace phrenic::study
