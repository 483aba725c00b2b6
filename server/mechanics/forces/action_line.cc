#include "server/mechanics/forces/action_line.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace phrenic {
namespace {

double FallOff(const v1::ActionLine& line, const Eigen::Vector3d& direction, const Eigen::Vector3d& point) {
  const Eigen::Vector3d offset = point - ToEigen(line.origin());
  const double height = offset.dot(direction);
  if (line.fall_off() == v1::FALL_OFF_VERTICAL) return std::max(0.0, height / line.radius());
  return std::max(0.0, 1 - (offset - height * direction).norm() / line.radius());
}

double Signal(const Instant& at) {
  return at.parameters.apply_muscles() ? at.parameters.breath_force() * at.breath : 0.0;
}

double Activation(v1::Side side, const v1::Parameters& parameters) {
  if (side == v1::SIDE_RIGHT) return parameters.right_activation();
  return side == v1::SIDE_LEFT ? parameters.left_activation() : 1.0;
}

}  // namespace

absl::StatusOr<std::unique_ptr<Force>> ActionLine::Make(const v1::ActionLine& scene, const std::string& given,
                                                        std::string_view path, Draft& draft) {
  const std::string name = ElementName(given, "action-line", scene.bodies());
  auto bodies = draft.DeformableBodies(scene.bodies(), absl::StrCat(std::string(path), ".bodies"));
  if (!bodies.ok()) return bodies.status();
  const Eigen::Vector3d along = ToEigen(scene.direction());
  if (along.norm() == 0) return FieldError(absl::StrCat(std::string(path), ".direction"), "must not be zero");
  const Eigen::Vector3d direction = along.normalized();
  std::unique_ptr<ActionLine> force(new ActionLine(name, scene, direction));
  double total = 0;
  for (const int b : *bodies) {
    const BodyModel& body = draft.model.bodies[b];
    for (int i = 0; i < body.mesh.vertices.cols(); ++i) {
      const int vertex = body.first_vertex + i;
      const double weight = FallOff(scene, direction, body.mesh.vertices.col(i)) * draft.model.mass[vertex];
      if (weight == 0 || draft.model.inverse_mass[vertex] == 0) continue;
      force->pulls_.push_back({vertex, weight});
      total += weight;
    }
  }
  if (force->pulls_.empty() || (scene.force() == 0 && scene.air_load() == 0)) {
    draft.ReportLeftOut(name, force->pulls_.empty() ? "no free vertex is within its reach" : "its force is 0");
    return nullptr;
  }
  for (Pull& pull : force->pulls_) pull.share /= total;
  std::sort(force->pulls_.begin(), force->pulls_.end(),
            [](const Pull& a, const Pull& b) { return a.vertex < b.vertex; });
  draft.model.action_lines.push_back({name, bodies->front(), ToEigen(scene.origin()), direction, scene.radius()});
  draft.ReportElement("force", name, static_cast<std::int64_t>(force->pulls_.size()), "vertices",
                      absl::StrFormat("%g N at the peak of a quiet breath", scene.force()));
  return force;
}

ActionLine::ActionLine(std::string name, const v1::ActionLine& scene, const Eigen::Vector3d& direction)
    : Force(std::move(name)),
      side_(scene.side()),
      force_(scene.force() * direction),
      muscle_((scene.force() + scene.lung_load()) * direction),
      air_(scene.air_load() * direction) {}

Eigen::Vector3d ActionLine::Whole(const Instant& at) const {
  const Eigen::Vector3d breath = force_ - (1 - Activation(side_, at.parameters)) * muscle_;
  return Signal(at) * breath + at.parameters.hyperinflation() * air_;
}

void ActionLine::AddForceIn(const VertexRange& range, const Instant& at, MutablePoints f) const {
  const Eigen::Vector3d force = Whole(at);
  if (force.isZero(0)) return;
  auto pull = std::lower_bound(pulls_.begin(), pulls_.end(), range.first,
                               [](const Pull& each, Eigen::Index vertex) { return each.vertex < vertex; });
  for (; pull != pulls_.end() && pull->vertex < range.end; ++pull) {
    Eigen::Map<Eigen::Vector3d>(f.data() + 3 * static_cast<std::ptrdiff_t>(pull->vertex)) += pull->share * force;
  }
}

double ActionLine::Energy(const Instant& at) const {
  const Eigen::Vector3d force = Whole(at);
  double work = 0;
  for (const Pull& pull : pulls_) work += pull.share * force.dot(at.x.col(pull.vertex));
  return -work;
}

}  // namespace phrenic
