#include "server/session/present_forces.h"

#include <algorithm>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "server/mechanics/step/force_reading.h"

namespace phrenic::session {
namespace {

absl::StatusOr<const BodyModel*> FindDeformable(const Model& model, const std::string& name) {
  std::vector<std::string> names;
  for (const BodyModel& body : model.bodies) {
    if (body.first_vertex < 0) continue;
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

void WriteForces(const ForceReading& reading, int vertex, v1::GetForcesResponse& response) {
  for (const std::string& kind : reading.kinds()) {
    const Eigen::Vector3d force = reading.Of(kind).col(vertex);
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
  const auto body = FindDeformable(model, request.body());
  if (!body.ok()) return body.status();
  const auto fork = (*session)->MakeFork();
  if (!fork.ok()) return fork.status();
  const ForceReading reading(model, fork->parameters, fork->state);
  if (absl::Status status = CheckRequest(request, **body, reading.kinds()); !status.ok()) return status;
  v1::GetForcesResponse response;
  response.set_tick(fork->state.tick);
  response.set_time(fork->state.time);
  response.mutable_kinds()->Add(reading.kinds().begin(), reading.kinds().end());
  if (request.has_vertex()) WriteForces(reading, (*body)->first_vertex + request.vertex(), response);
  if (!request.kind().empty()) {
    const Points forces = reading.Of(request.kind());
    const auto part = forces.middleCols((*body)->first_vertex, (*body)->mesh.vertices.cols());
    const Eigen::VectorXf sizes = part.colwise().norm().cast<float>();
    response.set_sizes(sizes.data(), sizeof(float) * static_cast<std::size_t>(sizes.size()));
  }
  return response;
}

}  // namespace phrenic::session
