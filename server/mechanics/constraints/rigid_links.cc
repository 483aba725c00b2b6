#include "server/mechanics/constraints/rigid_links.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "server/mechanics/constraints/link_pairing.h"

namespace phrenic {
namespace {

constexpr double kTolerance = 1e-10;  // of the length
constexpr int kSweeps = 200;

absl::StatusOr<Edges> ListedLinks(const v1::LinkList& list, int body, std::string_view path, const Draft& draft) {
  Edges edges(2, list.links_size());
  for (int i = 0; i < list.links_size(); ++i) {
    const std::string where = absl::StrCat(std::string(path), ".links[", i, "]");
    const int a = list.links(i).a(), b = list.links(i).b();
    if (absl::Status status = draft.CheckVertex(body, a, where); !status.ok()) return status;
    if (absl::Status status = draft.CheckVertex(body, b, where); !status.ok()) return status;
    if (a == b) return FieldError(where, absl::StrCat("joins vertex ", a, " to itself"));
    edges.col(i) = Eigen::Vector2i(a, b);
  }
  return edges;
}

absl::StatusOr<Edges> FindLinks(const v1::RigidLinks& scene, int body, const std::string& path, const Draft& draft) {
  switch (scene.which_case()) {
    case v1::RigidLinks::kPairing:
      return PairLinks(scene.pairing(), body, path + ".pairing", draft);
    case v1::RigidLinks::kList:
      return ListedLinks(scene.list(), body, path + ".list", draft);
    case v1::RigidLinks::WHICH_NOT_SET:
      break;
  }
  return FieldError(path, "says neither pairing nor list: which vertices are to be linked?");
}

bool AnyShared(const Edges& links, Eigen::Index vertices) {
  std::vector<bool> used(static_cast<size_t>(vertices), false);
  for (Eigen::Index i = 0; i < links.size(); ++i) {
    const auto vertex = static_cast<size_t>(links.data()[i]);
    if (used[vertex]) return true;
    used[vertex] = true;
  }
  return false;
}

// What to take off `between` along `direction` for its squared length to lose `excess`: the smaller root c of
// |between - c direction|^2 = |between|^2 - excess. Along `between` itself where the link has turned too far in one
// step for `direction` to reach; nothing where both ends are in one point.
Eigen::Vector3d Correction(const Eigen::Vector3d& between, const Eigen::Vector3d& direction, double excess) {
  const double along = between.dot(direction);
  const double discriminant = along * along - direction.squaredNorm() * excess;
  if (along > 0 && discriminant >= 0) return excess / (along + std::sqrt(discriminant)) * direction;
  const double squared = between.squaredNorm();
  if (squared == 0) return Eigen::Vector3d::Zero();
  return (1 - std::sqrt((squared - excess) / squared)) * between;
}

}  // namespace

absl::StatusOr<std::unique_ptr<Constraint>> RigidLinks::Make(const v1::RigidLinks& scene, const std::string& given,
                                                             std::string_view path, Draft& draft) {
  const std::string name = given.empty() ? absl::StrCat("rigid-links:", scene.body()) : given;
  const std::string field(path);
  auto b = draft.Body(scene.body(), absl::StrCat(field, ".body"));
  if (!b.ok()) return b.status();
  const int first = draft.model.bodies[*b].first_vertex;
  if (first < 0) return FieldError(absl::StrCat(field, ".body"), "the body is not ROLE_DEFORMABLE");
  auto found = FindLinks(scene, *b, field, draft);
  if (!found.ok()) return found.status();
  if (found->cols() == 0) {
    draft.ReportLeftOut(name, "no two vertices fit the pairing");
    return nullptr;
  }
  std::unique_ptr<RigidLinks> constraint(new RigidLinks(name));
  if (scene.projection() == v1::PROJECTION_THESIS) constraint->projection_ = v1::PROJECTION_THESIS;
  Model& model = draft.model;
  const Eigen::Index old = model.rigid_links.cols();
  model.rigid_links.conservativeResize(2, old + found->cols());
  for (Eigen::Index i = 0; i < found->cols(); ++i) {
    const int a = first + (*found)(0, i), c = first + (*found)(1, i);
    const double wa = model.inverse_mass[a], wc = model.inverse_mass[c], sum = wa + wc;
    constraint->links_.push_back(
        {a, c, (model.rest.col(a) - model.rest.col(c)).norm(), sum > 0 ? wa / sum : 0, sum > 0 ? wc / sum : 0});
    model.rigid_links.col(old + i) = Eigen::Vector2i(a, c);
  }
  constraint->shared_vertices_ = AnyShared(*found, draft.model.bodies[*b].mesh.vertices.cols());
  model.report.set_rigid_links(model.report.rigid_links() + found->cols());
  draft.ReportElement("constraint", name, found->cols(), "links",
                      scene.projection() == v1::PROJECTION_THESIS ? "split by distance moved (thesis 2.10-2.11)"
                                                                  : "mass-weighted, velocities corrected");
  return constraint;
}

double RigidLinks::Sweep(const ConstPoints& before, double dt, State& state) const {
  double worst = 0;
  for (const Link& link : links_) {
    const Eigen::Vector3d between = state.x.col(link.b) - state.x.col(link.a);
    const double excess = between.squaredNorm() - link.length * link.length;
    worst = std::max(worst, std::abs(excess) / (2 * link.length * link.length));
    const Eigen::Vector3d direction = before.col(link.b) - before.col(link.a);
    const Eigen::Vector3d correction = Correction(between, direction, excess);
    state.x.col(link.a) += link.share_a * correction;
    state.x.col(link.b) -= link.share_b * correction;
    state.v.col(link.a) += link.share_a / dt * correction;
    state.v.col(link.b) -= link.share_b / dt * correction;
  }
  return worst;
}

void RigidLinks::ProjectThesis(const ConstPoints& before, Points& x) const {
  for (const Link& link : links_) {
    const Eigen::Vector3d between = x.col(link.b) - x.col(link.a);
    const double length = between.norm();
    if (length == 0 || link.share_a + link.share_b == 0) continue;
    double a = link.share_a > 0 ? (x.col(link.a) - before.col(link.a)).norm() : 0;
    double b = link.share_b > 0 ? (x.col(link.b) - before.col(link.b)).norm() : 0;
    if (a + b == 0) a = link.share_a, b = link.share_b;  // neither moved: a fixed end still does not
    const Eigen::Vector3d correction = ((length - link.length) / length) * between;
    x.col(link.a) += a / (a + b) * correction;
    x.col(link.b) -= b / (a + b) * correction;
  }
}

void RigidLinks::Project(const v1::Parameters& parameters, const ConstPoints& before, double dt, State& state) const {
  if (!parameters.apply_links()) return;
  if (projection_ == v1::PROJECTION_THESIS) {
    ProjectThesis(before, state.x);
    return;
  }
  const int sweeps = shared_vertices_ ? kSweeps : 1;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    if (Sweep(before, dt, state) < kTolerance) break;
  }
}

double RigidLinks::Residual(const State& state) const {
  double worst = 0;
  for (const Link& link : links_) {
    worst = std::max(worst, std::abs((state.x.col(link.b) - state.x.col(link.a)).norm() - link.length));
  }
  return worst;
}

}  // namespace phrenic
