#include "server/mechanics/constraints/link.h"

#include <cmath>

#include "absl/strings/str_cat.h"

namespace phrenic {
namespace {

// Returns the correction c `direction` that reduces the squared length of `between` by `excess`: c is the smaller root
// of |between - c direction|^2 = |between|^2 - excess. If there is no root in that direction, a correction along
// `between`.
Eigen::Vector3d Correction(const Eigen::Vector3d& between, const Eigen::Vector3d& direction, double excess) {
  const double along = between.dot(direction);
  const double discriminant = along * along - direction.squaredNorm() * excess;
  if (along > 0 && discriminant >= 0) return excess / (along + std::sqrt(discriminant)) * direction;
  const double squared = between.squaredNorm();
  if (squared == 0) return Eigen::Vector3d::Zero();
  return (1 - std::sqrt((squared - excess) / squared)) * between;
}

}  // namespace

Link MakeLink(const Model& model, int a, int b) {
  return {a, b, (model.rest.col(a) - model.rest.col(b)).norm(), model.inverse_mass[a], model.inverse_mass[b]};
}

absl::StatusOr<std::vector<Link>> ListedLinks(const v1::LinkList& list, int body, std::string_view path,
                                              const ModelBuilder& builder) {
  std::vector<Link> links;
  const int first = builder.model.bodies[body].first_vertex;
  for (int i = 0; i < list.links_size(); ++i) {
    const std::string where = absl::StrCat(std::string(path), ".links[", i, "]");
    const int a = list.links(i).a(), b = list.links(i).b();
    if (absl::Status status = builder.CheckVertex(body, a, where); !status.ok()) return status;
    if (absl::Status status = builder.CheckVertex(body, b, where); !status.ok()) return status;
    if (a == b) return FieldError(where, absl::StrCat("links vertex ", a, " to itself"));
    links.push_back(MakeLink(builder.model, first + a, first + b));
    if (links.back().length > 0) continue;
    return FieldError(where, absl::StrCat("vertices ", a, " and ", b, " coincide: move one of them"));
  }
  return links;
}

absl::StatusOr<std::vector<Link>> ListedOrEdges(bool listed, const v1::LinkList& list, const std::string& region,
                                                int body, std::string_view path, const ModelBuilder& builder) {
  if (listed) return ListedLinks(list, body, absl::StrCat(std::string(path), ".list"), builder);
  auto inside = builder.Region(body, region, absl::StrCat(std::string(path), ".region"));
  if (!inside.ok()) return inside.status();
  const BodyModel& model = builder.model.bodies[body];
  std::vector<Link> links;
  const Edges& edges = builder.EdgesOf(body);
  for (const auto edge : edges.colwise()) {
    if (!(*inside)[edge[0]] || !(*inside)[edge[1]]) continue;
    const Link link = MakeLink(builder.model, model.first_vertex + edge[0], model.first_vertex + edge[1]);
    if (link.length > 0) links.push_back(link);
  }
  return links;
}

absl::Status TooTangled(std::string_view path, std::size_t links) {
  return absl::ResourceExhaustedError(absl::StrCat(
      std::string(path), ": its ", links,
      " links share so many vertices that they cannot be solved simultaneously: use fewer of them, or springs"));
}

absl::StatusOr<int> DeformableBody(const std::string& name, std::string_view path, const ModelBuilder& builder) {
  auto body = builder.Body(name, path);
  if (!body.ok() || builder.model.bodies[*body].first_vertex >= 0) return body;
  return FieldError(path, absl::StrCat("body \"", name, "\" must be ROLE_DEFORMABLE"));
}

void ApplyPositionImpulse(const Link& link, const Eigen::Vector3d& impulse, double dt, Points& x, Points& v) {
  x.col(link.a) += link.inverse_a * impulse;
  x.col(link.b) -= link.inverse_b * impulse;
  v.col(link.a) += link.inverse_a / dt * impulse;
  v.col(link.b) -= link.inverse_b / dt * impulse;
}

void Restore(const Link& link, const Eigen::Vector3d& direction, double dt, Points& x, Points& v) {
  if (!link.Movable()) return;
  const Eigen::Vector3d between = x.col(link.b) - x.col(link.a);
  const double excess = between.squaredNorm() - link.length * link.length;
  const Eigen::Vector3d correction = Correction(between, direction, excess);
  ApplyPositionImpulse(link, correction / (link.inverse_a + link.inverse_b), dt, x, v);
}

void ApplyVelocityImpulse(const Link& link, const Eigen::Vector3d& impulse, State& state) {
  state.v.col(link.a) += link.inverse_a * impulse;
  state.v.col(link.b) -= link.inverse_b * impulse;
}

void StopStretching(const Link& link, State& state) {
  const Eigen::Vector3d between = state.x.col(link.b) - state.x.col(link.a);
  const double squared = between.squaredNorm();
  if (!link.Movable() || squared == 0) return;
  const double rate = between.dot(state.v.col(link.b) - state.v.col(link.a)) / squared;
  ApplyVelocityImpulse(link, rate / (link.inverse_a + link.inverse_b) * between, state);
}

}  // namespace phrenic
