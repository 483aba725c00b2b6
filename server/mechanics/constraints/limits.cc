#include "server/mechanics/constraints/limits.h"

#include <algorithm>

#include "absl/strings/str_cat.h"

namespace phrenic {
namespace {

constexpr double kTolerance = 1e-10;  // of the length
constexpr double kReached = 1e-8;     // of the length: nearer to a limit than this is at it
constexpr double kAtRest = 1e-13;     // of the first rate: what is slower needs no more stopping
constexpr int kSweeps = 200;

absl::Status CheckRatios(const v1::Limits& scene, std::string_view path) {
  if (!scene.has_at_most_ratio() && !scene.has_at_least_ratio()) {
    return FieldError(path, "limits nothing: set at_most_ratio, at_least_ratio or both");
  }
  if (scene.has_at_most_ratio() && scene.has_at_least_ratio() && scene.at_least_ratio() > scene.at_most_ratio()) {
    return FieldError(absl::StrCat(std::string(path), ".at_least_ratio"), "must not be above at_most_ratio");
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<std::unique_ptr<Constraint>> Limits::Make(const v1::Limits& scene, const std::string& given,
                                                         std::string_view path, Draft& draft) {
  const std::string name = given.empty() ? absl::StrCat("limits:", scene.body()) : given;
  if (absl::Status status = CheckRatios(scene, path); !status.ok()) return status;
  auto body = DeformableBody(scene.body(), absl::StrCat(std::string(path), ".body"), draft);
  if (!body.ok()) return body.status();
  auto links = ListedOrEdges(scene.has_list(), scene.list(), scene.region(), *body, path, draft);
  if (!links.ok()) return links.status();
  std::unique_ptr<Limits> constraint(new Limits(name));
  for (Link link : *links) {
    if (!link.Movable()) continue;
    const double length = link.length;
    link.length = scene.at_most_ratio() * length;
    if (scene.has_at_most_ratio()) constraint->limits_.push_back({link, 1});
    link.length = scene.at_least_ratio() * length;
    if (scene.has_at_least_ratio()) constraint->limits_.push_back({link, -1});
  }
  if (constraint->limits_.empty()) {
    draft.ReportLeftOut(name, "no edge that can move has both its vertices in the region");
    return nullptr;
  }
  draft.ReportElement("constraint", name, static_cast<std::int64_t>(constraint->limits_.size()), "limits",
                      "mass-weighted where they are violated, velocities corrected");
  return constraint;
}

double Limits::Sweep(const ConstPoints& before, double dt, State& state) const {
  double worst = 0;
  for (const Limit& limit : limits_) {
    const double error = limit.sign * limit.link.RelativeError(state.x);
    if (error <= 0) continue;
    worst = std::max(worst, error);
    Restore(limit.link, before, dt, state);
  }
  return worst;
}

double Limits::SweepVelocities(State& state) const {
  double worst = 0;
  for (const Limit& limit : limits_) {
    const auto& [link, sign] = limit;
    if (sign * link.RelativeError(state.x) < -kReached) continue;
    const Eigen::Vector3d between = state.x.col(link.b) - state.x.col(link.a);
    const double rate = sign * between.dot(state.v.col(link.b) - state.v.col(link.a)) / link.length;
    if (rate <= 0) continue;
    worst = std::max(worst, rate);
    StopStretching(link, state);
  }
  return worst;
}

void Limits::Project(const v1::Parameters& parameters, const ConstPoints& before, double dt, State& state) const {
  if (!parameters.apply_links()) return;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    if (Sweep(before, dt, state) < kTolerance) break;
  }
}

void Limits::ProjectVelocities(const v1::Parameters& parameters, State& state) const {
  if (!parameters.apply_links()) return;
  const double first = SweepVelocities(state);
  for (int sweep = 1; sweep < kSweeps && first > 0; ++sweep) {
    if (SweepVelocities(state) <= kAtRest * first) break;
  }
}

double Limits::Residual(const State& state) const {
  double worst = 0;
  for (const Limit& limit : limits_) worst = std::max(worst, limit.sign * limit.link.Stretch(state.x));
  return worst;
}

}  // namespace phrenic
