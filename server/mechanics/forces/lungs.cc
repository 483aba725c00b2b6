#include "server/mechanics/forces/lungs.h"

#include <array>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace phrenic {
namespace {

constexpr std::array<Force::Output, 4> kLungOutputs = {
    {{"volume", "m^3"}, {"flow", "m^3/s"}, {"alveolar_pressure", "Pa"}, {"pleural_pressure", "Pa"}}};

absl::Status AddSurfaces(const v1::Lungs& scene, const std::string& path, const ModelBuilder& builder,
                         Chamber& chamber) {
  if (!scene.has_floor() && !scene.has_walls()) return FieldError(path, "bounds no thorax: set floor, walls or both");
  if (scene.has_floor()) {
    if (absl::Status s = chamber.Add(scene.floor(), -1, path + ".floor", builder); !s.ok()) return s;
  }
  if (scene.has_walls()) {
    if (absl::Status s = chamber.Add(scene.walls(), 1, path + ".walls", builder); !s.ok()) return s;
  }
  return chamber.SetPlane(nullptr, path);
}

}  // namespace

absl::StatusOr<std::unique_ptr<Force>> Lungs::Make(const v1::Lungs& scene, const std::string& given,
                                                   std::string_view path, ModelBuilder& builder) {
  Names bodies = scene.floor().bodies();
  bodies.MergeFrom(scene.walls().bodies());
  const std::string name = ElementName(given, "lungs", bodies);
  std::unique_ptr<Lungs> force(new Lungs(name));
  if (absl::Status s = AddSurfaces(scene, std::string(path), builder, force->chamber_); !s.ok()) return s;
  force->pushes_ = force->chamber_.pushes();
  force->compliance_ = scene.compliance();
  force->resistance_ = scene.resistance();
  force->rest_pressure_ = scene.rest_pressure();
  force->rest_volume_ = scene.rest_volume();
  builder.ReportElement("force", name, force->chamber_.triangles(), "triangles",
                        absl::StrFormat("%g m^3/Pa, %g Pa s/m^3%s", scene.compliance(), scene.resistance(),
                                        force->pushes_ ? "" : ", surface is not deformable: exerts no force"));
  return force;
}

void Lungs::AddForce(const EvalContext& at, MutablePoints f) const {
  if (pushes_) chamber_.AddAreas(at, PressureChange(chamber_.Read(at)), f);
}

void Lungs::AddStiffness(const EvalContext& at, StiffnessSink& sink) const {
  if (pushes_) sink.AddOuter(1 / compliance_, chamber_.AreaVectors(at));
}

void Lungs::AddSharedDamping(const EvalContext& at, OuterProducts& shared) const {
  if (has_shared_damping()) shared.Add(resistance_, chamber_.AreaVectors(at));
}

double Lungs::Energy(const EvalContext& at) const {
  const double change = Change(chamber_.Volume(at));
  return change * change / (2 * compliance_);
}

std::span<const Force::Output> Lungs::outputs() const { return kLungOutputs; }

double Lungs::Read(size_t output, const EvalContext& at) const {
  const ChamberReading read = chamber_.Read(at);
  switch (output) {
    case 0:
      return rest_volume_ + Change(read.volume);
    case 1:
      return read.flow;
    case 2:
      return AlveolarPressure(read);
    default:
      return rest_pressure_ + PressureChange(read);
  }
}

}  // namespace phrenic
