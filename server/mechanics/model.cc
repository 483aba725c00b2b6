#include "server/mechanics/model.h"

#include <cmath>
#include <numbers>

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

double BreathSignal(v1::Waveform waveform, double phase) {
  const double angle = 2 * std::numbers::pi * phase;
  if (waveform == v1::WAVEFORM_RAISED_COSINE) return (1 - std::cos(angle)) / 2;
  return std::sin(angle);
}

double BreathSlope(v1::Waveform waveform, double phase) {
  const double angle = 2 * std::numbers::pi * phase;
  if (waveform == v1::WAVEFORM_RAISED_COSINE) return std::numbers::pi * std::sin(angle);
  return 2 * std::numbers::pi * std::cos(angle);
}

EvalContext MakeEvalContext(const Model& model, const v1::Parameters& parameters, const State& state,
                            const Scratch& scratch) {
  return MakeEvalContext(model, parameters, state, state.time, state.phase, scratch);
}

EvalContext MakeEvalContext(const Model& model, const v1::Parameters& parameters, const State& state, double time,
                            double phase, const Scratch& scratch) {
  const v1::Waveform waveform = model.scene.breath().waveform();
  return {.time = time,
          .breath = BreathSignal(waveform, phase),
          .breath_rate = BreathSlope(waveform, phase) / parameters.breath_length(),
          .parameters = parameters,
          .x = state.x,
          .v = state.v,
          .poses = state.poses,
          .pulls = state.pulls,
          .scalars = state.scalars,
          .scratch = scratch};
}

}  // namespace phrenic
