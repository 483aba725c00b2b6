#include "server/mechanics/advance.h"

namespace phrenic {

Instant InstantAhead(const Model& model, const v1::Parameters& parameters, double ahead, const State& state) {
  return MakeInstant(model, parameters, state, state.time + ahead, state.phase + ahead / parameters.breath_length());
}

void DriveMotions(const Model& model, const v1::Parameters& parameters, double ahead, State& state) {
  if (model.motions.empty()) return;
  const Instant at = InstantAhead(model, parameters, ahead, state);
  for (const auto& motion : model.motions) motion->Drive(at, state);
}

void SumForces(const Model& model, const Instant& at, Points& f) {
  f.setZero();
  for (const auto& force : model.forces) force->AddForce(at, f);
}

void SumDamping(const Model& model, const Instant& at, Eigen::VectorXd& c) {
  c.setZero();
  for (const auto& force : model.forces) force->AddDamping(at, c);
}

void AddToFree(const Model& model, double scale, const Points& shift, Points& x) {
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    if (model.inverse_mass[i] > 0) x.col(i) += scale * shift.col(i);
  }
}

void ProjectPositions(const Model& model, const v1::Parameters& parameters, const ConstPoints& before, double dt,
                      State& state) {
  for (const auto& constraint : model.constraints) constraint->Project(parameters, before, dt, state);
}

void ProjectVelocities(const Model& model, const v1::Parameters& parameters, State& state) {
  for (const auto& constraint : model.constraints) constraint->ProjectVelocities(parameters, state);
}

}  // namespace phrenic
