#include "server/mechanics/measures/energy.h"

#include "absl/strings/str_cat.h"
#include "server/mechanics/measures/force_output.h"

namespace phrenic {
namespace {

class KineticMeasure final : public Measure {
 public:
  // The simulated vertices [first, first + masses.size()).
  struct Part {
    int first;
    Eigen::VectorXd masses;  // [kg]
  };
  KineticMeasure(std::string name, std::vector<Part> parts) : Measure(std::move(name), "J"), parts_(std::move(parts)) {}

  double Value(const EvalContext& at) const override {
    double twice = 0;
    for (const Part& part : parts_) {
      for (Eigen::Index i = 0; i < part.masses.size(); ++i) {
        twice += part.masses[i] * at.v.col(part.first + i).squaredNorm();
      }
    }
    return twice / 2;
  }

 private:
  std::vector<Part> parts_;
};

class ElasticMeasure final : public Measure {
 public:
  ElasticMeasure(std::string name, std::vector<const Force*> forces)
      : Measure(std::move(name), "J"), forces_(std::move(forces)) {}

  double Value(const EvalContext& at) const override {
    double sum = 0;
    for (const Force* force : forces_) sum += force->Energy(at);
    return sum;
  }

 private:
  std::vector<const Force*> forces_;  // of the same model
};

// True if a force of this kind stores energy by deformation: not gravity, contact, loads, pressures or active muscle.
bool Deforms(const std::string& kind) {
  const auto* field = v1::Force::descriptor()->FindFieldByName(kind);
  switch (static_cast<v1::Force::KindCase>(field->number())) {
    case v1::Force::kSprings:
    case v1::Force::kCables:
    case v1::Force::kMembrane:
    case v1::Force::kSolid:
    case v1::Force::kBending:
    case v1::Force::kCrossLayer:
    case v1::Force::kAttachment:
    case v1::Force::kTargetSpring:
      return true;
    case v1::Force::kMuscle:
    case v1::Force::kWallContact:
    case v1::Force::kChestWall:
    case v1::Force::kThoraxPressures:
    case v1::Force::kFriction:
    case v1::Force::kActionLine:
    case v1::Force::kFibres:
    case v1::Force::kGravity:
    case v1::Force::kContact:
    case v1::Force::kPressure:
    case v1::Force::kLungs:
    case v1::Force::kPointLoad:
    case v1::Force::KIND_NOT_SET:
      break;
  }
  return false;
}

absl::StatusOr<std::vector<const Force*>> ForcesWithEnergy(const v1::ElasticEnergy& scene, std::string_view path,
                                                           const ModelBuilder& builder) {
  std::vector<const Force*> forces;
  for (int i = 0; i < scene.forces_size(); ++i) {
    const std::string field = absl::StrCat(std::string(path), ".forces[", i, "]");
    const auto force = FindForce(scene.forces(i), field, builder);
    if (!force.ok()) return force.status();
    if (!(*force)->conservative()) return FieldError(field, absl::StrCat("\"", scene.forces(i), "\" has no energy"));
    forces.push_back(*force);
  }
  if (scene.forces_size() > 0) return forces;
  for (std::size_t i = 0; i < builder.model.forces.size(); ++i) {
    const Force& force = *builder.model.forces[i];
    if (force.conservative() && Deforms(builder.model.force_kinds[i])) forces.push_back(&force);
  }
  return forces;
}

}  // namespace

absl::StatusOr<std::unique_ptr<Measure>> MakeKineticEnergy(const v1::KineticEnergy& scene, const std::string& name,
                                                           std::string_view path, ModelBuilder& builder) {
  const auto bodies = builder.DeformableBodies(scene.bodies(), absl::StrCat(std::string(path), ".bodies"));
  if (!bodies.ok()) return bodies.status();
  std::vector<KineticMeasure::Part> parts;
  std::int64_t vertices = 0;
  for (const int b : *bodies) {
    const BodyModel& body = builder.model.bodies[b];
    parts.push_back({body.first_vertex, builder.model.mass.segment(body.first_vertex, body.mesh.vertices.cols())});
    vertices += body.mesh.vertices.cols();
  }
  builder.ReportElement("measure", name, vertices, "vertices", "kinetic energy");
  return std::make_unique<KineticMeasure>(name, std::move(parts));
}

absl::StatusOr<std::unique_ptr<Measure>> MakeElasticEnergy(const v1::ElasticEnergy& scene, const std::string& name,
                                                           std::string_view path, ModelBuilder& builder) {
  auto forces = ForcesWithEnergy(scene, path, builder);
  if (!forces.ok()) return forces.status();
  builder.ReportElement("measure", name, static_cast<std::int64_t>(forces->size()), "forces", "elastic energy");
  return std::make_unique<ElasticMeasure>(name, *std::move(forces));
}

}  // namespace phrenic
