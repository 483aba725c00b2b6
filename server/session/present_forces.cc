#include "server/session/present_forces.h"

#include <algorithm>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "server/mechanics/step/force_reading.h"

namespace phrenic::session {
namespace {

// Returns the sheet's bindings if the body is a layer of one.
const Skin* LayerSkin(const Model& model, const BodyModel& body) {
  if (body.skin < 0 || model.skins[static_cast<std::size_t>(body.skin)].sheet == nullptr) return nullptr;
  return &model.skins[static_cast<std::size_t>(body.skin)];
}

absl::StatusOr<const BodyModel*> FindTissue(const Model& model, const std::string& name) {
  std::vector<std::string> names;
  for (const BodyModel& body : model.bodies) {
    if (body.first_vertex < 0 && LayerSkin(model, body) == nullptr) continue;
    if (body.name == name) return &body;
    names.push_back(body.name);
  }
  return absl::InvalidArgumentError(absl::StrCat("body: there is no deformable body \"", name, "\"; there are ",
                                                 names.empty() ? "none" : absl::StrJoin(names, ", ")));
}

absl::Status CheckRequest(const v1::GetForcesRequest& request, const BodyModel& body,
                          const std::vector<std::string>& kinds) {
  if (request.has_vertex() && request.vertex() >= body.mesh.vertices.cols()) {
    return absl::InvalidArgumentError(absl::StrCat("vertex: there is no vertex ", request.vertex(), " in body \"",
                                                   body.name, "\": its vertices are 0 to ",
                                                   body.mesh.vertices.cols() - 1));
  }
  const bool known = request.kind().empty() || std::find(kinds.begin(), kinds.end(), request.kind()) != kinds.end();
  if (known) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrCat("kind: there is no force of kind \"", request.kind(), "\"; there are ", absl::StrJoin(kinds, ", ")));
}

// Returns the forces on a body's vertices [N], from those on the simulated vertices.
Points OnBody(const Model& model, const BodyModel& body, const Points& forces) {
  const Eigen::Index n = body.mesh.vertices.cols();
  const Skin* layer = LayerSkin(model, body);
  if (layer == nullptr) return forces.middleCols(body.first_vertex, n);
  Points on_layer(3, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const TriangleBinding& binding = layer->triangles[static_cast<std::size_t>(i)];
    on_layer.col(i) = forces(Eigen::all, binding.corners) * binding.weights;
  }
  return on_layer;
}

void WriteForces(const Model& model, const BodyModel& body, const ForceReading& reading, int vertex,
                 v1::GetForcesResponse& response) {
  for (const std::string& kind : reading.kinds()) {
    const Eigen::Vector3d force = OnBody(model, body, reading.Of(kind)).col(vertex);
    v1::Vector& row = *response.add_forces();
    row.set_x(force.x());
    row.set_y(force.y());
    row.set_z(force.z());
  }
}

}  // namespace

absl::StatusOr<v1::GetForcesResponse> ReadForces(const Table& table, const v1::GetForcesRequest& request) {
  const auto session = table.Find(request.session_id());
  if (!session.ok()) return session.status();
  const Model& model = (*session)->model();
  const auto body = FindTissue(model, request.body());
  if (!body.ok()) return body.status();
  const auto fork = (*session)->MakeFork();
  if (!fork.ok()) return fork.status();
  const ForceReading reading(model, fork->parameters, fork->state);
  if (absl::Status status = CheckRequest(request, **body, reading.kinds()); !status.ok()) return status;
  v1::GetForcesResponse response;
  response.set_tick(fork->state.tick);
  response.set_time(fork->state.time);
  response.mutable_kinds()->Add(reading.kinds().begin(), reading.kinds().end());
  if (request.has_vertex()) WriteForces(model, **body, reading, request.vertex(), response);
  if (!request.kind().empty()) {
    const Points forces = OnBody(model, **body, reading.Of(request.kind()));
    const Eigen::VectorXf sizes = forces.colwise().norm().cast<float>();
    response.set_sizes(sizes.data(), sizeof(float) * static_cast<std::size_t>(sizes.size()));
  }
  return response;
}

}  // namespace phrenic::session
