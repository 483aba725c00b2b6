#include "server/mechanics/forces/action_line.h"

#include <algorithm>
#include <vector>

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

// Returns which vertices an action line that was made before pulls.
std::vector<bool> PulledBefore(const Model& model) {
  std::vector<bool> pulled(static_cast<std::size_t>(model.rest.cols()), false);
  for (const auto& force : model.forces) {
    const auto* line = dynamic_cast<const ActionLine*>(force.get());
    if (line == nullptr) continue;
    for (Eigen::Index i = 0; i < line->weights().size(); ++i) {
      if (line->weights()[i] > 0) pulled[static_cast<std::size_t>(i)] = true;
    }
  }
  return pulled;
}

double Signal(const EvalContext& at) {
  return at.parameters.apply_muscles() ? at.parameters.breath_force() * at.breath : 0.0;
}

double Activation(v1::Side side, const v1::Parameters& parameters) {
  if (side == v1::SIDE_RIGHT) return parameters.right_activation();
  return side == v1::SIDE_LEFT ? parameters.left_activation() : 1.0;
}

}  // namespace

absl::StatusOr<std::unique_ptr<Force>> ActionLine::Make(const v1::ActionLine& scene, const std::string& given,
                                                        std::string_view path, ModelBuilder& builder) {
  const std::string name = ElementName(given, "action-line", scene.bodies());
  auto bodies = builder.DeformableBodies(scene.bodies(), absl::StrCat(std::string(path), ".bodies"));
  if (!bodies.ok()) return bodies.status();
  const Eigen::Vector3d along = ToEigen(scene.direction());
  if (along.norm() == 0) return FieldError(absl::StrCat(std::string(path), ".direction"), "must not be zero");
  const Eigen::Vector3d direction = along.normalized();
  std::unique_ptr<ActionLine> force(new ActionLine(name, scene, direction));
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(builder.model.rest.cols());
  const bool skips = scene.overlap() == v1::OVERLAP_SKIP_PULLED;
  const std::vector<bool> pulled = skips ? PulledBefore(builder.model) : std::vector<bool>();
  std::int64_t count = 0;
  for (const int b : *bodies) {
    const BodyModel& body = builder.model.bodies[b];
    for (int i = 0; i < body.mesh.vertices.cols(); ++i) {
      const int vertex = body.first_vertex + i;
      const double weight = FallOff(scene, direction, body.mesh.vertices.col(i)) * builder.model.mass[vertex];
      if (weight == 0 || builder.model.inverse_mass[vertex] == 0) continue;
      if (skips && pulled[static_cast<std::size_t>(vertex)]) continue;
      weights[vertex] = weight;
      ++count;
    }
  }
  if (count == 0 || (scene.force() == 0 && scene.air_load() == 0)) {
    builder.ReportLeftOut(name, count == 0 ? (skips ? "no free vertex that no earlier line pulls is within its reach"
                                                    : "no free vertex is within its reach")
                                           : "its force is 0");
    return nullptr;
  }
  force->SetWeights(weights / weights.sum());
  builder.model.action_lines.push_back({name, bodies->front(), ToEigen(scene.origin()), direction, scene.radius()});
  builder.ReportElement("force", name, count, "vertices",
                        absl::StrFormat("%g N at the peak of a quiet breath", scene.force()));
  return force;
}

ActionLine::ActionLine(std::string name, const v1::ActionLine& scene, const Eigen::Vector3d& direction)
    : SharedForce(std::move(name)),
      side_(scene.side()),
      force_(scene.force() * direction),
      muscle_((scene.force() + scene.lung_load()) * direction),
      air_(scene.air_load() * direction) {}

Eigen::Vector3d ActionLine::Whole(const EvalContext& at) const {
  const Eigen::Vector3d breath = force_ - (1 - Activation(side_, at.parameters)) * muscle_;
  return Signal(at) * breath + at.parameters.hyperinflation() * air_;
}

}  // namespace phrenic
