#include "server/mechanics/forces/point_load.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace phrenic {
namespace {

absl::Status CheckSelection(const v1::PointLoad& scene, std::string_view path) {
  if (scene.region().empty() && scene.vertices().empty()) {
    return FieldError(path, "says no place: set vertices, or a region");
  }
  if (!scene.region().empty() && !scene.vertices().empty()) {
    return FieldError(absl::StrCat(std::string(path), ".region"), "vertices are named as well: set one of the two");
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<std::unique_ptr<Force>> PointLoad::Make(const v1::PointLoad& scene, const std::string& given,
                                                       std::string_view path, ModelBuilder& builder) {
  const std::string name = given.empty() ? absl::StrCat("point-load:", scene.body()) : given;
  Names body;
  *body.Add() = scene.body();
  auto bodies = builder.DeformableBodies(body, absl::StrCat(std::string(path), ".body"));
  if (!bodies.ok()) return bodies.status();
  if (bodies->size() != 1)
    return FieldError(absl::StrCat(std::string(path), ".body"), "names several bodies; a point load acts on one");
  if (absl::Status status = CheckSelection(scene, path); !status.ok()) return status;
  auto vertices = builder.FreeVertices(bodies->front(), scene.region(), scene.vertices(), path);
  if (!vertices.ok()) return vertices.status();
  std::unique_ptr<PointLoad> force(new PointLoad(name));
  force->vertices_ = *std::move(vertices);
  std::sort(force->vertices_.begin(), force->vertices_.end());
  force->scaled_by_breath_ = scene.scaled_by_breath();
  const Eigen::Vector3d total = ToEigen(scene.force());
  if (force->vertices_.empty() || total.isZero(0)) {
    builder.ReportLeftOut(name, force->vertices_.empty() ? "none of its vertices is free" : "its force is 0");
    return nullptr;
  }
  force->load_ = total / static_cast<double>(force->vertices_.size());
  builder.ReportElement(
      "force", name, static_cast<std::int64_t>(force->vertices_.size()), "vertices",
      absl::StrFormat("%g N in total%s", total.norm(), force->scaled_by_breath_ ? ", scaled by the breath" : ""));
  return force;
}

Eigen::Vector3d PointLoad::LoadAt(const EvalContext& at) const {
  return (scaled_by_breath_ ? at.parameters.breath_force() * at.breath : 1.0) * load_;
}

void PointLoad::AddForceToBlock(const VertexRange& range, const BlockContext& at, MutablePoints f) const {
  const Eigen::Vector3d load = LoadAt(at);
  auto vertex = std::lower_bound(vertices_.begin(), vertices_.end(), range.first);
  for (; vertex != vertices_.end() && *vertex < range.end; ++vertex) f.col(*vertex - range.first) += load;
}

double PointLoad::Energy(const EvalContext& at) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const int vertex : vertices_) sum += at.x.col(vertex);
  return -LoadAt(at).dot(sum);
}

}  // namespace phrenic
