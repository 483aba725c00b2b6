#include "server/session/present_body.h"

#include <numeric>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "server/mechanics/skinning/body_points.h"
#include "server/mechanics/skinning/tissue_bodies.h"

namespace phrenic::session {
namespace {

bool HasSurface(const BodyModel& body) { return body.mesh.triangles.cols() > 0; }

// Returns the body of tissue with the most triangles; null if none has any.
const BodyModel* Largest(const Model& model) {
  const BodyModel* largest = nullptr;
  for (const int b : TissueBodies(model)) {
    const BodyModel& body = model.bodies[static_cast<std::size_t>(b)];
    if (!HasSurface(body)) continue;
    if (largest == nullptr || body.mesh.triangles.cols() > largest->mesh.triangles.cols()) largest = &body;
  }
  return largest;
}

absl::StatusOr<int> Find(const Model& model, const std::string& name) {
  const BodyModel* largest = Largest(model);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    const BodyModel& body = model.bodies[i];
    if (!HasSurface(body)) continue;
    if (name.empty() ? &body == largest : body.name == name) return static_cast<int>(i);
    names.push_back(body.name);
  }
  const std::string there =
      names.empty() ? "no body has a surface" : absl::StrCat("there are ", absl::StrJoin(names, ", "));
  if (name.empty()) {
    return absl::InvalidArgumentError(absl::StrCat("body: no deformable body has a surface; name another: ", there));
  }
  return absl::InvalidArgumentError(absl::StrCat("body: there is no body \"", name, "\" with a surface; ", there));
}

}  // namespace

absl::StatusOr<Mesh> FindPresentBody(const Table& table, const v1::SessionBody& wanted, v1::ComparedState& state) {
  const auto session = table.Find(wanted.session_id());
  if (!session.ok()) return session.status();
  const Model& model = (*session)->model();
  const auto index = Find(model, wanted.body());
  if (!index.ok()) return index.status();
  const auto present = (*session)->ReadState();
  if (!present.ok()) return present.status();
  const BodyModel& body = model.bodies[static_cast<std::size_t>(*index)];
  Mesh mesh = body.mesh;
  PlaceBody(model, present->state(), *index, mesh.vertices);
  std::vector<int>& whole = mesh.regions[body.name];
  whole.resize(static_cast<std::size_t>(mesh.vertices.cols()));
  std::iota(whole.begin(), whole.end(), 0);
  state.set_session_id(wanted.session_id());
  state.set_body(body.name);
  state.set_tick(present->state().tick);
  state.set_time(present->state().time);
  return mesh;
}

}  // namespace phrenic::session
