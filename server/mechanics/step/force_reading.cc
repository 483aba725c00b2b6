#include "server/mechanics/step/force_reading.h"

#include <algorithm>

#include "server/mechanics/step/step_plan.h"

namespace phrenic {
namespace {

constexpr char kConstraints[] = "constraints", kPull[] = "pull", kNet[] = "net";

}  // namespace

ForceReading::ForceReading(const Model& model, const v1::Parameters& parameters, const State& state)
    : model_(model), parameters_(parameters), dt_(std::min(parameters.time_step(), kLongestReading)), state_(state) {
  model.plan->DriveMotions(parameters, dt_, scratch_, state_);
  for (const std::string& kind : model.force_kinds) {
    if (std::find(kinds_.begin(), kinds_.end(), kind) == kinds_.end()) kinds_.push_back(kind);
  }
  if (!model.constraints.empty()) kinds_.emplace_back(kConstraints);
  if (!state.pulls.empty()) kinds_.emplace_back(kPull);
  kinds_.emplace_back(kNet);
}

Points ForceReading::Of(const std::string& kind) const {
  if (kind == kNet) return Sum() + Constraints();
  if (kind == kPull) return Pulls();
  return kind == kConstraints ? Constraints() : Elements(kind);
}

Points ForceReading::Elements(const std::string& kind) const {
  Points force = Points::Zero(3, state_.x.cols());
  const EvalContext at = MakeEvalContext(model_, parameters_, state_, scratch_);
  for (std::size_t i = 0; i < model_.forces.size(); ++i) {
    if (model_.force_kinds[i] == kind) model_.forces[i]->AddForce(at, force);
  }
  return force;
}

Points ForceReading::Pulls() const {
  Points force = Points::Zero(3, state_.x.cols());
  for (const VertexPull& pull : state_.pulls) force.col(pull.vertex) += pull.force;
  return force;
}

Points ForceReading::Sum() const {
  Points force(3, state_.x.cols());
  model_.plan->SumForces(MakeEvalContext(model_, parameters_, state_, scratch_), force);
  return force;
}

Points ForceReading::Constraints() const {
  Points force = Points::Zero(3, state_.x.cols());
  if (model_.constraints.empty()) return force;
  State after = state_;
  model_.plan->AddToFree(dt_, Sum() * model_.inverse_mass.asDiagonal(), after.v);
  const Points free = after.v;
  model_.plan->AddToFree(dt_, free, after.x);
  model_.plan->ProjectPositions(parameters_, state_.x, dt_, scratch_, after);
  for (Eigen::Index i = 0; i < force.cols(); ++i) {
    if (model_.inverse_mass[i] > 0) force.col(i) = (after.v.col(i) - free.col(i)) / (dt_ * model_.inverse_mass[i]);
  }
  return force;
}

}  // namespace phrenic
