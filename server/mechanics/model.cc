#include "server/mechanics/model.h"

#include <cmath>
#include <numbers>

#include "server/mechanics/advance.h"

namespace phrenic {

State Model::InitialState() const {
  State state;
  state.x = rest;
  state.v = Points::Zero(3, rest.cols());
  int poses = 0;
  for (const BodyModel& body : bodies) poses += body.pose >= 0 ? 1 : 0;
  state.poses.resize(poses);
  const Instant start = MakeInstant(*this, parameters, state);
  for (const auto& motion : motions) motion->Drive(start, state);
  return state;
}

Workspace Model::MakeWorkspace() const {
  Workspace work;
  work.before = work.velocity_before = work.force = Points::Zero(3, rest.cols());
  work.damping = Eigen::VectorXd::Zero(rest.cols());
  MakePlaces(rest.cols(), work.reach);
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

Instant MakeInstant(const Model& model, const v1::Parameters& parameters, const State& state) {
  return MakeInstant(model, parameters, state, state.time, state.phase);
}

Instant MakeInstant(const Model& model, const v1::Parameters& parameters, const State& state, double time,
                    double phase) {
  const v1::Waveform waveform = model.scene.breath().waveform();
  return {.time = time,
          .breath = BreathSignal(waveform, phase),
          .breath_rate = BreathSlope(waveform, phase) / parameters.breath_length(),
          .parameters = parameters,
          .x = state.x,
          .v = state.v,
          .poses = state.poses,
          .pulls = state.pulls};
}

namespace {

void PlaceOnTriangles(const std::vector<TriangleShare>& shares, const Points& x, MutablePoints out) {
  for (size_t i = 0; i < shares.size(); ++i) {
    const TriangleShare& share = shares[i];
    const Eigen::Vector3d a = x.col(share.corners[0]), b = x.col(share.corners[1]), c = x.col(share.corners[2]);
    const Eigen::Vector3d normal = (b - a).cross(c - a).stableNormalized();
    out.col(static_cast<Eigen::Index>(i)) =
        share.weights[0] * a + share.weights[1] * b + share.weights[2] * c + share.height * normal;
  }
}

void PlaceRide(const Model& model, const State& state, const BodyModel& body, MutablePoints out) {
  if (!model.rides[body.ride].triangles.empty()) {
    return PlaceOnTriangles(model.rides[body.ride].triangles, state.x, out);
  }
  out = body.mesh.vertices;
  std::vector<Eigen::Matrix3d> rotations;  // once a pose, not once a vertex
  rotations.reserve(state.poses.size());
  for (const Pose& pose : state.poses) rotations.push_back(pose.rotation.toRotationMatrix());
  for (const RideShare& share : model.rides[body.ride].shares) {
    if (share.pose >= 0) {
      const auto pose = static_cast<size_t>(share.pose);
      const Eigen::Vector3d rest = body.mesh.vertices.col(share.vertex);
      out.col(share.vertex) += share.weight * (rotations[pose] * rest + state.poses[pose].translation - rest);
    } else {
      const int carrier = share.simulated_vertex;
      out.col(share.vertex) += share.weight * (state.x.col(carrier) - model.rest.col(carrier));
    }
  }
}

}  // namespace

void PlaceBody(const Model& model, const State& state, int body_index, MutablePoints out) {
  const BodyModel& body = model.bodies[body_index];
  if (body.first_vertex >= 0) {
    out = state.x.middleCols(body.first_vertex, body.mesh.vertices.cols());
  } else if (body.pose >= 0) {
    const Pose& pose = state.poses[body.pose];
    out = (pose.rotation.toRotationMatrix() * body.mesh.vertices).colwise() + pose.translation;
  } else if (body.ride >= 0) {
    PlaceRide(model, state, body, out);
  } else {
    out = body.mesh.vertices;
  }
}

}  // namespace phrenic
