#include "server/mechanics/pulls.h"

#include <algorithm>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"

namespace phrenic {
namespace {

// The bindings of a body to triangles of deformable ones, one per vertex; null if it has none.
const std::vector<TriangleBinding>* BindingsOf(const Model& model, const BodyModel& body) {
  if (body.skin < 0 || model.skins[body.skin].triangles.empty()) return nullptr;
  return &model.skins[body.skin].triangles;
}

bool CanBePulled(const Model& model, const BodyModel& body) {
  return body.first_vertex >= 0 || BindingsOf(model, body) != nullptr;
}

// Returns the simulated vertex that moves a vertex of the body: that vertex, or the corner next to it.
int MovingVertex(const Model& model, const BodyModel& body, int vertex) {
  if (body.first_vertex >= 0) return body.first_vertex + vertex;
  const TriangleBinding& binding = (*BindingsOf(model, body))[static_cast<std::size_t>(vertex)];
  Eigen::Index nearest = 0;
  binding.weights.maxCoeff(&nearest);
  return binding.corners[nearest];
}

absl::Status NoSuchBody(const Model& model, const std::string& name, const std::string& path) {
  std::vector<std::string> names;
  for (const BodyModel& body : model.bodies) {
    if (CanBePulled(model, body)) names.push_back(body.name);
  }
  return absl::InvalidArgumentError(absl::StrCat(path, ".body: there is no deformable body \"", name, "\"; there are ",
                                                 names.empty() ? "none" : absl::StrJoin(names, ", ")));
}

absl::StatusOr<int> FindVertex(const Model& model, const v1::Pull& pull, const std::string& path) {
  const auto body = std::find_if(model.bodies.begin(), model.bodies.end(),
                                 [&](const BodyModel& b) { return b.name == pull.body() && CanBePulled(model, b); });
  if (body == model.bodies.end()) return NoSuchBody(model, pull.body(), path);
  const auto vertices = body->mesh.vertices.cols();
  if (pull.vertex() < 0 || pull.vertex() >= vertices) {
    return absl::InvalidArgumentError(absl::StrCat(path, ".vertex: there is no vertex ", pull.vertex(), " in body \"",
                                                   pull.body(), "\": its vertices are 0 to ", vertices - 1));
  }
  const int vertex = MovingVertex(model, *body, pull.vertex());
  if (model.inverse_mass[vertex] > 0) return vertex;
  return absl::InvalidArgumentError(absl::StrCat(path, ".vertex: vertex ", pull.vertex(), " of body \"", pull.body(),
                                                 "\" is fixed or driven and follows no pull; choose another"));
}

}  // namespace

absl::StatusOr<std::vector<VertexPull>> FindPulls(const Model& model, const PullList& list, std::string_view path) {
  std::vector<VertexPull> pulls;
  for (int i = 0; i < list.size(); ++i) {
    const std::string field = absl::StrCat(std::string(path), "[", i, "]");
    const auto vertex = FindVertex(model, list[i], field);
    if (!vertex.ok()) return vertex.status();
    const Eigen::Vector3d force(list[i].force().x(), list[i].force().y(), list[i].force().z());
    if (!(force.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() <= kMostPull)) {
      return absl::InvalidArgumentError(
          absl::StrFormat("%s.force: (%g, %g, %g) N is outside -%g to %g N along each axis", field, force.x(),
                          force.y(), force.z(), kMostPull, kMostPull));
    }
    pulls.push_back({*vertex, force});
  }
  return pulls;
}

absl::Status ChangePulls(const std::vector<VertexPull>& changes, bool alone, std::vector<VertexPull>& pulls) {
  std::vector<VertexPull> changed;
  if (!alone) changed = pulls;
  for (const VertexPull& change : changes) {
    const auto same = std::find_if(changed.begin(), changed.end(),
                                   [&change](const VertexPull& pull) { return pull.vertex == change.vertex; });
    const bool lets_go = change.force.isZero(0);
    if (same == changed.end()) {
      if (!lets_go) changed.push_back(change);
    } else if (lets_go) {
      changed.erase(same);
    } else {
      *same = change;
    }
  }
  if (changed.size() > kMostPulls) {
    return absl::ResourceExhaustedError(absl::StrCat("pulls: there would be ", changed.size(), " of them, and ",
                                                     kMostPulls, " are allowed; let go of some first"));
  }
  pulls = std::move(changed);
  return absl::OkStatus();
}

PullList DescribePulls(const Model& model, const std::vector<VertexPull>& pulls) {
  PullList list;
  for (const VertexPull& pull : pulls) {
    const BodyModel& body = model.BodyOf(pull.vertex);
    v1::Pull& row = *list.Add();
    row.set_body(body.name);
    row.set_vertex(pull.vertex - body.first_vertex);
    row.mutable_force()->set_x(pull.force.x());
    row.mutable_force()->set_y(pull.force.y());
    row.mutable_force()->set_z(pull.force.z());
  }
  return list;
}

}  // namespace phrenic
