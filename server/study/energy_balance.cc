#include "server/study/energy_balance.h"

#include <algorithm>
#include <numeric>

#include "server/study/watched_run.h"

namespace phrenic::study {

void EnergyBalance::AddReleased(const EvalContext& at) {
  const auto& forces = subject_.model->forces;
  potential_at_start_.resize(forces.size());
  released_.resize(forces.size());
  for (size_t i = 0; i < forces.size(); ++i) {
    if (!forces[i]->conservative()) continue;
    const double potential = forces[i]->Energy(at);
    if (!started_) potential_at_start_[i] = potential;
    released_[i] = std::max(released_[i], potential_at_start_[i] - potential);
  }
}

// Adds the positive work of non-conservative forces since the last state, by the trapezoidal rule.
void EnergyBalance::AddWork(const EvalContext& at, const State& state) {
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
  const EvalContext at = MakeEvalContext(*subject_.model, subject_.parameters, state);
  AddWork(at, state);
  AddReleased(at);
  const double kinetic = KineticEnergy(*subject_.model, state.v);
  if (!started_) kinetic_at_start_ = kinetic;
  started_ = true;
  largest_ = std::max(largest_, kinetic);
}

double EnergyBalance::ratio() const {
  const double released = std::accumulate(released_.begin(), released_.end(), 0.0);
  return largest_ > 0 ? largest_ / (kinetic_at_start_ + released + done_) : 0;
}

}  // namespace phrenic::study
