#include "server/mechanics/forces/fibres.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mesh/harmonic.h"

namespace phrenic {
namespace {

constexpr double kLevel = 1e-9;     // the harmonic function counts as constant if it changes by less over a triangle
constexpr double kShortest = 1e-3;  // lower bound of the stretch by which the tension is divided

Eigen::Vector2d Across(const Eigen::Vector2d& along) { return {-along[1], along[0]}; }

}  // namespace

absl::StatusOr<std::unique_ptr<Force>> Fibres::Make(const v1::Fibres& scene, const std::string& given,
                                                    std::string_view path, ModelBuilder& builder) {
  const std::string name = ElementName(given, "fibres", scene.bodies());
  const auto bodies = builder.DeformableBodies(scene.bodies(), absl::StrCat(std::string(path), ".bodies"));
  if (!bodies.ok()) return bodies.status();
  std::unique_ptr<Fibres> force(new Fibres(name, scene));
  for (const int b : *bodies) {
    if (absl::Status status = force->AddBody(scene, b, path, builder); !status.ok()) return status;
  }
  if (force->strips_.empty()) {
    builder.ReportLeftOut(name, "no triangle of the region lies between the two regions");
    return nullptr;
  }
  builder.ReportElement("force", name, static_cast<std::int64_t>(force->strips_.size()), "triangles",
                        absl::StrFormat("%g Pa along, %g Pa across, %g Pa active", scene.modulus_along(),
                                        scene.modulus_across(), scene.active_stress()));
  return force;
}

absl::Status Fibres::AddBody(const v1::Fibres& scene, int b, std::string_view path, const ModelBuilder& builder) {
  const BodyModel& body = builder.model.bodies[b];
  const std::string field(path);
  const auto from = builder.Region(b, scene.from_region(), field + ".from_region");
  if (!from.ok()) return from.status();
  const auto to = builder.Region(b, scene.to_region(), field + ".to_region");
  if (!to.ok()) return to.status();
  const auto selection = builder.Select(b, scene.region(), scene.exclude_region(), path);
  if (!selection.ok()) return selection.status();
  const auto harmonic = HarmonicBetween(body.mesh, *from, *to);
  if (!harmonic.ok()) return FieldError(path, std::string(harmonic.status().message()));
  for (Eigen::Index t = 0; t < body.mesh.triangles.cols(); ++t) {
    const Eigen::Vector3i corners = body.mesh.triangles.col(t);
    if (!selection->Takes(corners)) continue;
    const Eigen::Vector3i vertices = corners.array() + body.first_vertex;
    const FiniteElement<2> element = MakeTriangle(builder.model.rest, vertices, scene.thickness());
    const Eigen::Vector3d value((*harmonic)[corners[0]], (*harmonic)[corners[1]], (*harmonic)[corners[2]]);
    if (element.volume == 0 || value.maxCoeff() - value.minCoeff() < kLevel) continue;
    strips_.push_back({element, (element.gradient * value).normalized()});
  }
  return absl::OkStatus();
}

Points Fibres::Directions() const {
  Points directions(3, static_cast<Eigen::Index>(strips_.size()));
  for (size_t i = 0; i < strips_.size(); ++i) {
    directions.col(static_cast<Eigen::Index>(i)) = strips_[i].element.axes * strips_[i].along;
  }
  return directions;
}

double Fibres::ActiveStress(const EvalContext& at) const {
  if (!at.parameters.apply_muscles()) return 0;
  return active_stress_ * at.parameters.breath_force() * std::max(0.0, at.breath);
}

Fibres::Tension Fibres::TensionOf(const Eigen::Vector3d& stretched, double modulus, double active) {
  const double stretch = stretched.norm();
  if (stretch == 0) return {0, 0, Eigen::Vector3d::Zero()};
  return {stretch, modulus * (stretch - 1) + active, stretched / stretch};
}

void Fibres::AddForce(const EvalContext& at, MutablePoints f) const {
  const double active = ActiveStress(at), elasticity = at.parameters.elasticity();
  for (const Strip& strip : strips_) {
    const Gradient<2> gradient = DeformationOf(strip.element, at.x);
    const Eigen::Vector2d across = Across(strip.along);
    const Tension lengthwise = TensionOf(gradient * strip.along, elasticity * along_, active);
    const Tension crosswise = TensionOf(gradient * across, elasticity * across_, 0);
    AddStress<2>(strip.element,
                 lengthwise.tension * lengthwise.unit * strip.along.transpose() +
                     crosswise.tension * crosswise.unit * across.transpose(),
                 f);
  }
}

void Fibres::AddStiffness(const EvalContext& at, StiffnessSink& sink) const {
  const double active = ActiveStress(at), elasticity = at.parameters.elasticity();
  const auto add = [&sink](const Strip& strip, const Eigen::Vector2d& direction, const Tension& state, double modulus) {
    const Eigen::Matrix3d lengthwise = state.unit * state.unit.transpose();
    const double transverse = std::max(0.0, state.tension) / std::max(state.stretch, kShortest);
    const Eigen::Matrix3d block =
        strip.element.volume * (modulus * lengthwise + transverse * (Eigen::Matrix3d::Identity() - lengthwise));
    const Eigen::Vector3d slope = strip.element.gradient.transpose() * direction;
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b)
        sink.Add(strip.element.vertices[a], strip.element.vertices[b], slope[a] * slope[b] * block);
    }
  };
  for (const Strip& strip : strips_) {
    const Gradient<2> gradient = DeformationOf(strip.element, at.x);
    const Eigen::Vector2d across = Across(strip.along);
    add(strip, strip.along, TensionOf(gradient * strip.along, elasticity * along_, active), elasticity * along_);
    add(strip, across, TensionOf(gradient * across, elasticity * across_, 0), elasticity * across_);
  }
}

double Fibres::Energy(const EvalContext& at) const {
  const double active = ActiveStress(at), elasticity = at.parameters.elasticity();
  double energy = 0;
  for (const Strip& strip : strips_) {
    const Gradient<2> gradient = DeformationOf(strip.element, at.x);
    const double along = (gradient * strip.along).norm(), across = (gradient * Across(strip.along)).norm();
    const double passive = along_ * (along - 1) * (along - 1) + across_ * (across - 1) * (across - 1);
    energy += strip.element.volume * (elasticity * passive / 2 + active * along);
  }
  return energy;
}

}  // namespace phrenic
