#include "server/mechanics/forces/pressure.h"

#include <array>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace phrenic {
namespace {

constexpr std::array<Force::Output, 2> kPressureOutputs = {{{"pressure", "Pa"}, {"volume", "m^3"}}};

std::string Detail(const v1::Pressure& scene) {
  std::string detail = absl::StrFormat("%g Pa", scene.pressure());
  if (scene.breath_pressure() != 0)
    absl::StrAppendFormat(&detail, ", %g Pa scaled by the breath", scene.breath_pressure());
  if (scene.has_compliance()) absl::StrAppendFormat(&detail, ", %g m^3/Pa", scene.compliance());
  return detail;
}

}  // namespace

absl::StatusOr<std::unique_ptr<Force>> Pressure::Make(const v1::Pressure& scene, const std::string& given,
                                                      std::string_view path, ModelBuilder& builder) {
  const std::string name = ElementName(given, "pressure", scene.surface().bodies());
  const std::string field = absl::StrCat(std::string(path), ".surface");
  if (auto bodies = builder.DeformableBodies(scene.surface().bodies(), field + ".bodies"); !bodies.ok()) {
    return bodies.status();
  }
  if (scene.pressure() == 0 && scene.breath_pressure() == 0 && !scene.has_compliance()) {
    builder.ReportLeftOut(name, "its pressure is 0");
    return nullptr;
  }
  std::unique_ptr<Pressure> force(new Pressure(name));
  Chamber& chamber = force->chamber_;
  if (absl::Status s = chamber.Add(scene.surface(), 1, field, builder); !s.ok()) return s;
  const std::string plane = absl::StrCat(std::string(path), ".plane");
  if (absl::Status s = chamber.SetPlane(scene.has_plane() ? &scene.plane() : nullptr, plane); !s.ok()) return s;
  force->constant_ = scene.pressure();
  force->breath_ = scene.breath_pressure();
  force->stiffness_ = scene.has_compliance() ? 1 / scene.compliance() : 0;
  force->rest_volume_ = scene.has_rest_volume() ? scene.rest_volume() : chamber.rest_volume();
  force->conserves_ = chamber.conserves(builder.model);
  builder.ReportElement("force", name, chamber.triangles(), "triangles", Detail(scene));
  return force;
}

double Pressure::Given(const EvalContext& at) const {
  return constant_ + breath_ * at.parameters.breath_force() * at.breath;
}

double Pressure::PressureAt(const EvalContext& at) const {
  const double given = Given(at);
  return stiffness_ == 0 ? given : given - stiffness_ * (chamber_.Volume(at) - rest_volume_);
}

void Pressure::AddForce(const EvalContext& at, MutablePoints f) const { chamber_.AddAreas(at, PressureAt(at), f); }

void Pressure::AddStiffness(const EvalContext& at, StiffnessSink& sink) const {
  if (stiffness_ != 0) sink.AddOuter(stiffness_, chamber_.AreaVectors(at));
}

// Adds an upper bound of the term that AddStiffness leaves out: the row of corner a of a triangle abc has the blocks
// p/6 [b - c]x, p/6 [c - a]x and p/6 [a - b]x, whose norms are p/6 times the edge lengths.
void Pressure::AddLatentStiffness(const EvalContext& at, StiffnessSink& sink) const {
  const double p =
      std::abs(PressureAt(at) - Given(at)) + std::abs(constant_) + std::abs(breath_) * at.parameters.breath_force();
  chamber_.ForEachSimulated([&](const Eigen::Vector3i& corners) {
    double perimeter = 0;
    for (int i = 0; i < 3; ++i) perimeter += (at.x.col(corners[i]) - at.x.col(corners[(i + 1) % 3])).norm();
    for (const int vertex : corners) sink.Add(vertex, vertex, p / 6 * perimeter * Eigen::Matrix3d::Identity());
  });
}

double Pressure::Energy(const EvalContext& at) const {
  const double volume = chamber_.Volume(at), change = volume - rest_volume_;
  return -Given(at) * volume + 0.5 * stiffness_ * change * change;
}

std::span<const Force::Output> Pressure::outputs() const { return kPressureOutputs; }

double Pressure::Read(size_t output, const EvalContext& at) const {
  return output == 0 ? PressureAt(at) : chamber_.Volume(at);
}

}  // namespace phrenic
