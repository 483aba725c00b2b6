#include "server/mechanics/skinning/probe_position.h"

#include "server/mechanics/skinning/body_points.h"

namespace phrenic {

Eigen::Vector3d ProbePosition(const Model& model, const State& state, const Probe& probe) {
  const BodyModel& body = model.bodies[probe.body];
  if (body.first_vertex >= 0) return state.x.col(body.first_vertex + probe.vertex);
  Eigen::Vector3d rest = body.mesh.vertices.col(probe.vertex);
  if (body.pose >= 0) return state.poses[body.pose].At(rest);
  if (body.skin < 0) return rest;
  Points placed(3, body.mesh.vertices.cols());
  PlaceBody(model, state, probe.body, placed);
  return placed.col(probe.vertex);
}

}  // namespace phrenic
