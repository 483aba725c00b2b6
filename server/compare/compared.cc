#include "server/compare/compared.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/compare/moments.h"
#include "server/mesh/units.h"

namespace phrenic::compare {
namespace {

absl::StatusOr<Compared> ReadFile(const v1::ComparedSurface& file, const char* field) {
  if (file.name().empty()) return absl::InvalidArgumentError(absl::StrCat(field, ".name: must be set for a file"));
  const double unit = kMillimetre * (file.has_unit_mm() ? file.unit_mm() : 1);
  auto motion = meshio::ParseMotion(file.name(), file.content(), unit);
  if (!motion.ok()) return motion.status();
  double largest = motion->mesh.vertices.cwiseAbs().maxCoeff();
  for (const Points& displacement : motion->displacements) {
    largest = std::max(largest, displacement.cwiseAbs().maxCoeff());
  }
  if (largest <= kMaxCoordinate) return Compared{file.name(), *std::move(motion), std::nullopt};
  return absl::InvalidArgumentError(
      absl::StrCat(file.name(), ":1: has a coordinate of ", largest, " m; is unit_mm right?"));
}

absl::StatusOr<Compared> ReadBody(const v1::ComparedSurface& surface, const char* field, BodySource bodies) {
  for (const auto& [set, name] : {std::pair(surface.has_unit_mm(), "unit_mm"), std::pair(surface.has_time(), "time")}) {
    if (!set) continue;
    return absl::InvalidArgumentError(
        absl::StrCat(field, ".", name, ": applies to files only; leave it out for a body"));
  }
  Compared compared;
  auto mesh = bodies(surface.body(), compared.state.emplace());
  if (!mesh.ok()) return mesh.status();
  compared.motion.mesh = *std::move(mesh);
  compared.name = surface.name();
  if (compared.name.empty()) {
    compared.name = absl::StrCat("session:", compared.state->session_id(), "/", compared.state->body());
  }
  return compared;
}

absl::StatusOr<Compared> Read(const v1::ComparedSurface& surface, const char* field, BodySource bodies) {
  switch (surface.source_case()) {
    case v1::ComparedSurface::kBody:
      return ReadBody(surface, field, bodies);
    case v1::ComparedSurface::kContent:
    case v1::ComparedSurface::SOURCE_NOT_SET:
      break;
  }
  return ReadFile(surface, field);
}

// Reduces a motion to the state at one time, if the request or the other side sets a time.
absl::Status ChooseState(const v1::ComparedSurface& asked, const std::optional<v1::ComparedState>& other,
                         Compared& compared) {
  if (!compared.motion.moves() || (!asked.has_time() && !other)) return absl::OkStatus();
  const double time = asked.has_time() ? asked.time() : other->time();
  const auto state = FindTime(compared.motion.times, time);
  if (!state) {
    return absl::FailedPreconditionError(absl::StrFormat(
        "%s: has no state at %g s%s; its times are %g to %g s: choose one of them", compared.name, time,
        asked.has_time() ? "" : ", the session's time", compared.motion.times.front(), compared.motion.times.back()));
  }
  compared.motion.mesh.vertices = PositionsAt(compared.motion, *state);
  compared.motion.times.clear();
  compared.motion.displacements.clear();
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<ComparedPair> ReadPair(const v1::CompareRequest& request, BodySource bodies) {
  auto a = Read(request.a(), "a", bodies);
  if (!a.ok()) return a.status();
  auto b = Read(request.b(), "b", bodies);
  if (!b.ok()) return b.status();
  if (absl::Status status = ChooseState(request.a(), b->state, *a); !status.ok()) return status;
  if (absl::Status status = ChooseState(request.b(), a->state, *b); !status.ok()) return status;
  return ComparedPair{*std::move(a), *std::move(b)};
}

}  // namespace phrenic::compare
