#include "server/mechanics/model.h"

#include <cmath>
#include <numbers>

#include "server/mechanics/breath_signal.h"
#include "server/mechanics/parallel/vertex_range.h"

namespace phrenic {

State Model::InitialState() const {
  State state;
  state.x = rest;
  state.v = initial_velocity.cols() > 0 ? initial_velocity : Points::Zero(3, rest.cols());
  int poses = 0;
  for (const BodyModel& body : bodies) poses += body.pose >= 0 ? 1 : 0;
  state.poses.resize(poses);
  const auto scalar_count = static_cast<Eigen::Index>(scalars.size());
  state.scalars = {Eigen::VectorXd(scalar_count), Eigen::VectorXd(scalar_count)};
  for (Eigen::Index i = 0; i < scalar_count; ++i) {
    state.scalars.q[i] = scalars[i].initial;
    state.scalars.v[i] = scalars[i].initial_rate;
  }
  const EvalContext start = MakeEvalContext(*this, parameters, state);
  for (const auto& motion : motions) motion->Drive(start, state);
  return state;
}

Workspace Model::MakeWorkspace() const {
  Workspace work;
  work.before = work.velocity_before = work.force = Points::Zero(3, rest.cols());
  work.damping = Eigen::VectorXd::Zero(rest.cols());
  work.bounds.reserve(static_cast<size_t>(CountBlocks(rest.cols())) + 1);
  return work;
}

const BodyModel& Model::BodyOf(int simulated_vertex) const {
  const BodyModel* found = &bodies.front();
  for (const BodyModel& body : bodies) {
    if (body.first_vertex >= 0 && body.first_vertex <= simulated_vertex) found = &body;
  }
  return *found;
}

EvalContext MakeEvalContext(const Model& model, const v1::Parameters& parameters, const State& state,
                            const Scratch& scratch) {
  return MakeEvalContext(model, parameters, state, state.time, state.phase, scratch);
}

EvalContext MakeEvalContext(const Model& model, const v1::Parameters& parameters, const State& state, double time,
                            double phase, const Scratch& scratch) {
  const BreathSignal signal = BreathSignalAt(model.scene.breath(), parameters, phase);
  return {.time = time,
          .breath = signal.value,
          .breath_rate = signal.slope / parameters.breath_length(),
          .expiration = signal.expiration,
          .airway_closed = parameters.airway_closed() || signal.glottis_closed,
          .parameters = parameters,
          .x = state.x,
          .v = state.v,
          .poses = state.poses,
          .pulls = state.pulls,
          .scalars = state.scalars,
          .scratch = scratch};
}

}  // namespace phrenic
