#include "server/mechanics/skinning/probe_position.h"

#include "server/mechanics/skinning/body_points.h"

namespace phrenic {

Eigen::Vector3d ProbePosition(const Model& model, const State& state, const Probe& probe, const Scratch& scratch) {
  const BodyModel& body = model.bodies[probe.body];
  if (body.first_vertex >= 0) return state.x.col(body.first_vertex + probe.vertex);
  Eigen::Vector3d rest = body.mesh.vertices.col(probe.vertex);
  if (body.pose >= 0) return state.poses[body.pose].At(rest);
  if (body.skin < 0) return rest;
  const EvalContext at = MakeEvalContext(model, model.parameters, state, scratch);
  return BodyPoints(model, probe.body).Positions(at).col(probe.vertex);
}

}  // namespace phrenic
