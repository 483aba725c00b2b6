#include "server/mechanics/constraints/limits.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "server/mechanics/constraints/swept_links.h"

namespace phrenic {
namespace {

absl::Status CheckRatios(const v1::LengthLimits& scene, std::string_view path) {
  if (!scene.has_at_most_ratio() && !scene.has_at_least_ratio()) {
    return FieldError(path, "limits nothing: set at_most_ratio, at_least_ratio or both");
  }
  if (scene.has_at_most_ratio() && scene.has_at_least_ratio() && scene.at_least_ratio() > scene.at_most_ratio()) {
    return FieldError(absl::StrCat(std::string(path), ".at_least_ratio"), "must not be above at_most_ratio");
  }
  return absl::OkStatus();
}

// Returns one Link per ratio that is set, for each link with a movable end.
std::vector<Link> MakeLimits(const v1::LengthLimits& scene, const std::vector<Link>& links) {
  std::vector<Link> limits;
  for (Link link : links) {
    if (!link.Movable()) continue;
    const double length = link.length;
    link.length = scene.at_most_ratio() * length;
    link.sign = 1;
    if (scene.has_at_most_ratio()) limits.push_back(link);
    link.length = scene.at_least_ratio() * length;
    link.sign = -1;
    if (scene.has_at_least_ratio()) limits.push_back(link);
  }
  return limits;
}

}  // namespace

absl::StatusOr<std::unique_ptr<Constraint>> Limits::Make(const v1::LengthLimits& scene, const std::string& given,
                                                         std::string_view path, ModelBuilder& builder) {
  const std::string name = given.empty() ? absl::StrCat("length_limits:", scene.body()) : given;
  if (absl::Status status = CheckRatios(scene, path); !status.ok()) return status;
  auto body = DeformableBody(scene.body(), absl::StrCat(std::string(path), ".body"), builder);
  if (!body.ok()) return body.status();
  auto links = ListedOrEdges(scene.has_list(), scene.list(), scene.region(), *body, path, builder);
  if (!links.ok()) return links.status();
  const std::vector<Link> limits = MakeLimits(scene, *links);
  if (limits.empty()) {
    builder.ReportLeftOut(name, "no edge with a movable vertex has both vertices in the region");
    return nullptr;
  }
  if (scene.sweeps() > 0) return SweptLinks::Make(name, limits, scene.sweeps(), builder);
  std::unique_ptr<Limits> constraint(new Limits(name));
  constraint->network_ = LinkNetwork(limits);
  if (!constraint->network_.complete()) return TooTangled(path, limits.size());
  builder.ReportElement("constraint", name, static_cast<std::int64_t>(limits.size()), "limits",
                        "mass-weighted projection of violated limits, velocities corrected");
  return constraint;
}

void Limits::Project(const v1::Parameters& parameters, const ConstPoints& before, double dt, const Scratch& scratch,
                     State& state) const {
  if (parameters.apply_links()) network_.Project(before, dt, scratch, state);
}

void Limits::ProjectVelocities(const v1::Parameters& parameters, const Scratch& scratch, State& state) const {
  if (parameters.apply_links()) network_.ProjectVelocities(scratch, state);
}

void Limits::ListLinks(std::vector<Link>& links) const {
  links.insert(links.end(), network_.links().begin(), network_.links().end());
}

bool Limits::SameMotion(const ConstPoints& before, const ConstPoints& after) const {
  return std::none_of(network_.links().begin(), network_.links().end(),
                      [&](const Link& limit) { return limit.Reached(before) != limit.Reached(after); });
}

double Limits::Residual(const State& state) const {
  double worst = 0;
  for (const Link& limit : network_.links()) worst = std::max(worst, limit.Violation(limit.Stretch(state.x)));
  return worst;
}

}  // namespace phrenic
