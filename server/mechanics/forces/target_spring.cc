#include "server/mechanics/forces/target_spring.h"

#include <cmath>
#include <limits>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mesh/triangle_tree.h"

namespace phrenic {
namespace {

std::string FieldOf(std::string_view path, const char* field) { return absl::StrCat(std::string(path), ".", field); }

// The body may be driven, but neither give way nor ride on others.
absl::StatusOr<int> FirmSurface(const std::string& name, std::string_view path, const ModelBuilder& builder) {
  auto found = builder.Body(name, path);
  if (!found.ok()) return found;
  const BodyModel& body = builder.model.bodies[*found];
  if (body.first_vertex >= 0 || body.skin >= 0) {
    return FieldError(path, absl::StrCat("body \"", name, "\" is deformable, or rides on others, and cannot be a ",
                                         "target; name a body that is driven or at rest"));
  }
  if (body.mesh.triangles.cols() == 0) {
    return FieldError(path, absl::StrCat("body \"", name, "\" has no triangles to draw to"));
  }
  return found;
}

}  // namespace

absl::StatusOr<std::unique_ptr<Force>> TargetSpring::Make(const v1::TargetSpring& scene, const std::string& given,
                                                          std::string_view path, ModelBuilder& builder) {
  const std::string name = ElementName(given, "target_spring", scene.bodies());
  auto bodies = builder.DeformableBodies(scene.bodies(), FieldOf(path, "bodies"));
  if (!bodies.ok()) return bodies.status();
  if (!scene.vertices().empty() && bodies->size() != 1) {
    return FieldError(FieldOf(path, "vertices"),
                      "are of one body, and several are named: write one target_spring for each");
  }
  std::unique_ptr<TargetSpring> force(new TargetSpring(name));
  force->stiffness_ = scene.stiffness();
  force->damping_ratio_ = scene.damping_ratio();
  force->breathes_ = scene.scaled_by_breath();
  for (const int b : *bodies) {
    if (absl::Status status = force->AddDraws(scene, b, path, builder); !status.ok()) return status;
  }
  if (absl::Status status = force->FindTargets(scene, path, builder); !status.ok()) return status;
  if (force->draws_.empty() || scene.stiffness() == 0) {
    builder.ReportLeftOut(name, force->draws_.empty() ? "none of its vertices is free" : "its stiffness is 0");
    return nullptr;
  }
  builder.ReportElement("force", name, static_cast<std::int64_t>(force->draws_.size()), "vertices",
                        absl::StrFormat("to their targets, k = %g N/m%s", scene.stiffness(),
                                        force->breathes_ ? ", with the breath" : ""));
  return force;
}

absl::Status TargetSpring::AddDraws(const v1::TargetSpring& scene, int body, std::string_view path,
                                    ModelBuilder& builder) {
  const auto vertices = builder.FreeVertices(body, scene.region(), scene.vertices(), path);
  if (!vertices.ok()) return vertices.status();
  for (const int vertex : *vertices) {
    const Eigen::Vector3d rest = builder.model.rest.col(vertex);
    draws_.push_back({vertex, 2 * damping_ratio_ * std::sqrt(stiffness_ * builder.model.mass[vertex]), rest, rest});
  }
  return absl::OkStatus();
}

absl::Status TargetSpring::FindTargets(const v1::TargetSpring& scene, std::string_view path,
                                       const ModelBuilder& builder) {
  switch (scene.target_case()) {
    case v1::TargetSpring::kDisplacement:
      for (Draw& draw : draws_) draw.target = draw.rest + ToEigen(scene.displacement());
      return absl::OkStatus();
    case v1::TargetSpring::kPoint:
      for (Draw& draw : draws_) draw.target = ToEigen(scene.point());
      return absl::OkStatus();
    case v1::TargetSpring::kSurface:
      return FindSurfaceTargets(scene, path, builder);
    case v1::TargetSpring::TARGET_NOT_SET:
      break;
  }
  return FieldError(path, "says no target: set displacement, point or surface");
}

absl::Status TargetSpring::FindSurfaceTargets(const v1::TargetSpring& scene, std::string_view path,
                                              const ModelBuilder& builder) {
  const auto found = FirmSurface(scene.surface(), FieldOf(path, "surface"), builder);
  if (!found.ok()) return found.status();
  const BodyModel& surface = builder.model.bodies[*found];
  pose_ = surface.pose;
  const TriangleTree tree(surface.mesh.vertices, surface.mesh.triangles);
  TriangleTree::Boxes boxes;
  tree.Fit(surface.mesh.vertices, boxes);
  const double reach = std::numeric_limits<double>::infinity();
  for (Draw& draw : draws_) {
    draw.target = draw.rest + tree.Nearest(surface.mesh.vertices, boxes, draw.rest, reach).offset;
  }
  return absl::OkStatus();
}

TargetSpring::Aim TargetSpring::AimOf(const Draw& draw, const EvalContext& at) const {
  Aim aim{draw.target, Eigen::Vector3d::Zero()};
  if (pose_ >= 0) aim = {at.poses[pose_].At(draw.target), at.poses[pose_].VelocityAt(draw.target)};
  if (!breathes_) return aim;
  const double signal = at.parameters.breath_force() * at.breath;
  const Eigen::Vector3d way = aim.place - draw.rest;
  return {draw.rest + signal * way, signal * aim.velocity + at.parameters.breath_force() * at.breath_rate * way};
}

void TargetSpring::AddForce(const EvalContext& at, MutablePoints f) const {
  for (const Draw& draw : draws_) {
    const Aim aim = AimOf(draw, at);
    f.col(draw.vertex) +=
        stiffness_ * (aim.place - at.x.col(draw.vertex)) + draw.damping * (aim.velocity - at.v.col(draw.vertex));
  }
}

void TargetSpring::AddStiffness(const EvalContext&, StiffnessSink& sink) const {
  for (const Draw& draw : draws_) sink.Add(draw.vertex, draw.vertex, stiffness_ * Eigen::Matrix3d::Identity());
}

void TargetSpring::AddDamping(const EvalContext&, Eigen::VectorXd& c) const {
  for (const Draw& draw : draws_) c[draw.vertex] += draw.damping;
}

double TargetSpring::Energy(const EvalContext& at) const {
  double energy = 0;
  for (const Draw& draw : draws_) energy += (AimOf(draw, at).place - at.x.col(draw.vertex)).squaredNorm();
  return stiffness_ / 2 * energy;
}

}  // namespace phrenic
