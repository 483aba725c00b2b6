#include "server/study/energy_balance.h"

#include <algorithm>

#include "server/study/watched_run.h"

namespace phrenic::study {

double EnergyBalance::Potential(const Instant& at) const {
  double energy = 0;
  for (const auto& force : subject_.model->forces) {
    if (force->conservative()) energy += force->Energy(at);
  }
  return energy;
}

// The trapezoidal rule along the way from the last state.
void EnergyBalance::AddWork(const Instant& at, const State& state) {
  const Model& model = *subject_.model;
  force_.setZero(3, state.x.cols());
  for (const auto& force : model.forces) {
    if (!force->conservative()) force->AddForce(at, force_);
  }
  double work = 0;
  for (Eigen::Index i = 0; started_ && i < state.x.cols(); ++i) {
    if (model.inverse_mass[i] == 0) continue;
    work += 0.5 * (force_.col(i) + last_force_.col(i)).dot(state.x.col(i) - last_x_.col(i));
  }
  done_ += std::max(0.0, work);
  last_force_ = force_;
  last_x_ = state.x;
}

void EnergyBalance::Add(const State& state) {
  const Instant at = MakeInstant(*subject_.model, subject_.parameters, state);
  AddWork(at, state);
  const double kinetic = KineticEnergy(*subject_.model, state.v), potential = Potential(at);
  if (!started_) {
    kinetic_at_start_ = kinetic;
    potential_at_start_ = potential;
    started_ = true;
  }
  largest_ = std::max(largest_, kinetic);
  released_ = std::max(released_, potential_at_start_ - potential);
}

double EnergyBalance::ratio() const { return largest_ > 0 ? largest_ / (kinetic_at_start_ + released_ + done_) : 0; }

}  // namespace phrenic::study
