#include "server/mechanics/constraints/rigid_links.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "server/mechanics/constraints/link_pairing.h"
#include "server/mechanics/share_out.h"

namespace phrenic {
namespace {

constexpr size_t kTogether = 8;  // packets that one thread of a step takes at a time

absl::StatusOr<std::vector<Link>> PairedLinks(const v1::LinkPairing& scene, int body, const std::string& path,
                                              const Draft& draft) {
  auto pairs = PairLinks(scene, body, path, draft);
  if (!pairs.ok()) return pairs.status();
  const int first = draft.model.bodies[body].first_vertex;
  std::vector<Link> links;
  for (const auto pair : pairs->colwise()) links.push_back(MakeLink(draft.model, first + pair[0], first + pair[1]));
  return links;
}

absl::StatusOr<std::vector<Link>> FindLinks(const v1::RigidLinks& scene, int body, const std::string& path,
                                            const Draft& draft) {
  switch (scene.which_case()) {
    case v1::RigidLinks::kPairing:
      return PairedLinks(scene.pairing(), body, path + ".pairing", draft);
    case v1::RigidLinks::kList:
      return ListedLinks(scene.list(), body, path + ".list", draft);
    case v1::RigidLinks::WHICH_NOT_SET:
      break;
  }
  return FieldError(path, "says neither pairing nor list: which vertices are to be linked?");
}

// How many links have an end in each vertex that moves by forces.
std::vector<int> LinksPerVertex(const std::vector<Link>& links, const Model& model) {
  std::vector<int> count(static_cast<size_t>(model.rest.cols()), 0);
  for (const Link& link : links) {
    count[link.a] += link.inverse_a > 0;
    count[link.b] += link.inverse_b > 0;
  }
  return count;
}

bool NoVertexTwice(const std::vector<Link>& links, const Model& model) {
  std::vector<bool> taken(static_cast<size_t>(model.rest.cols()), false);
  for (const Link& link : links) {
    if (taken[link.a] || taken[link.b] || link.a == link.b) return false;
    taken[link.a] = taken[link.b] = true;
  }
  return true;
}

// For viewers.
void Show(const std::vector<Link>& links, Model& model) {
  Eigen::Index at = model.rigid_links.cols();
  model.rigid_links.conservativeResize(2, at + static_cast<Eigen::Index>(links.size()));
  for (const Link& link : links) model.rigid_links.col(at++) = Eigen::Vector2i(link.a, link.b);
}

}  // namespace

absl::StatusOr<std::unique_ptr<Constraint>> RigidLinks::Make(const v1::RigidLinks& scene, const std::string& given,
                                                             std::string_view path, Draft& draft) {
  const std::string name = given.empty() ? absl::StrCat("rigid-links:", scene.body()) : given;
  const std::string field(path);
  auto b = DeformableBody(scene.body(), absl::StrCat(field, ".body"), draft);
  if (!b.ok()) return b.status();
  auto links = FindLinks(scene, *b, field, draft);
  if (!links.ok()) return links.status();
  if (links->empty()) {
    draft.ReportLeftOut(name, "no two vertices fit the pairing");
    return nullptr;
  }
  std::unique_ptr<RigidLinks> constraint(new RigidLinks(name));
  constraint->thesis_ = scene.projection() == v1::PROJECTION_THESIS;
  constraint->Sort(*links, draft.model);
  Show(*links, draft.model);
  const auto count = static_cast<std::int64_t>(links->size());
  draft.model.report.set_rigid_links(draft.model.report.rigid_links() + count);
  draft.ReportElement("constraint", name, count, "links",
                      constraint->thesis_ ? "split by distance moved (thesis 2.10-2.11)"
                                          : absl::StrCat("mass-weighted, velocities corrected; ",
                                                         constraint->network_.links().size(), " solved together"));
  return constraint;
}

void RigidLinks::Sort(const std::vector<Link>& links, const Model& model) {
  const std::vector<int> count = LinksPerVertex(links, model);
  std::vector<Link> joined;
  for (const Link& link : links) {
    const bool alone = thesis_ || (count[link.a] < 2 && count[link.b] < 2);
    if (alone) {
      alone_.push_back(link);
    } else if (link.Movable()) {
      joined.push_back(link);
    }
  }
  if (!thesis_) packets_ = PackLinks(alone_);
  apart_ = NoVertexTwice(alone_, model);
  if (!joined.empty()) network_ = LinkNetwork(joined);
}

void RigidLinks::ProjectThesis(const ConstPoints& before, Points& x) const {
  for (const Link& link : alone_) {
    const Eigen::Vector3d between = x.col(link.b) - x.col(link.a);
    const double length = between.norm();
    if (length == 0 || !link.Movable()) continue;
    double a = link.inverse_a > 0 ? (x.col(link.a) - before.col(link.a)).norm() : 0;
    double b = link.inverse_b > 0 ? (x.col(link.b) - before.col(link.b)).norm() : 0;
    if (a + b == 0) a = link.inverse_a, b = link.inverse_b;  // neither moved: a fixed end still does not
    const Eigen::Vector3d correction = ((length - link.length) / length) * between;
    x.col(link.a) += a / (a + b) * correction;
    x.col(link.b) -= b / (a + b) * correction;
  }
}

void RigidLinks::RestoreAlone(const ConstPoints& before, double dt, State& state) const {
  if (packets_.empty()) return;
  const size_t together = apart_ ? kTogether : packets_.size();
  ShareOut(static_cast<std::int64_t>((packets_.size() - 1) / together + 1), [&](std::int64_t part) {
    const size_t first = static_cast<size_t>(part) * together, end = std::min(first + together, packets_.size());
    for (size_t p = first; p < end; ++p) {
      unsigned missed = RestorePacket(packets_[p], before.data(), dt, state.x.data(), state.v.data());
      for (size_t link = p * kPacketLinks; missed != 0; ++link, missed >>= 1) {
        if (missed & 1) Restore(alone_[link], before, dt, state);
      }
    }
  });
}

void RigidLinks::Project(const v1::Parameters& parameters, const ConstPoints& before, double dt, State& state) const {
  if (!parameters.apply_links()) return;
  if (thesis_) {
    ProjectThesis(before, state.x);
    return;
  }
  RestoreAlone(before, dt, state);
  network_.Project(before, dt, state);
}

void RigidLinks::ProjectVelocities(const v1::Parameters& parameters, State& state) const {
  if (!parameters.apply_links() || thesis_) return;
  for (const Link& link : alone_) StopStretching(link, state);
  network_.ProjectVelocities(state);
}

double RigidLinks::Residual(const State& state) const {
  double worst = 0;
  for (const Link& link : alone_) {
    if (link.Movable()) worst = std::max(worst, std::abs(link.Stretch(state.x)));
  }
  for (const Link& link : network_.links()) worst = std::max(worst, std::abs(link.Stretch(state.x)));
  return worst;
}

}  // namespace phrenic
