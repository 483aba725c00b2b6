#include "server/fluoroscopy/absorbers.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>

#include "server/fluoroscopy/attenuation.h"
#include "server/fluoroscopy/closing.h"
#include "server/fluoroscopy/outline.h"
#include "server/mechanics/skinning/body_points.h"
#include "server/mesh/normals.h"
#include "server/mesh/topology.h"

namespace phrenic::fluoroscopy {
namespace {

constexpr double kShell = 0.0012;  // thickness of the cortical shell of a rib [m]

// The tissue of a body; nullopt for one without a surface.
std::optional<Tissue> TissueOfBody(const BodyModel& body) {
  if (body.mesh.triangles.size() == 0) return std::nullopt;
  return TissueOf(body.name, body.layer.empty() ? body.name : body.layer);
}

class Collector {
 public:
  Collector(const Model& model, const State& state) : model_(model), state_(state), tissues_(TissuesOf(model)) {
    if (std::any_of(tissues_.begin(), tissues_.end(), IsBone)) outside_ = CoefficientOf(Tissue::kWall);
  }

  void Add(int b) {
    const BodyModel& body = model_.bodies[b];
    const std::optional<Tissue> tissue = tissues_[static_cast<std::size_t>(b)];
    if (!tissue) return;
    Points placed(3, body.mesh.vertices.cols());
    PlaceBody(model_, state_, b, placed);
    if (IsBone(tissue)) {
      bones_.push_back(placed);
      Extend(bone_box_, body.mesh.vertices);
    }
    if (*tissue == Tissue::kLung) Extend(lung_box_, body.mesh.vertices);
    const std::optional<Triangles> triangles = ClosedTriangles(body.mesh.vertices, body.mesh.triangles);
    if (triangles) {
      AddClosed(body, *tissue, placed, *triangles);
    } else {
      found_.open.push_back(body.name);
    }
  }

  Absorbers Finish() {
    const Eigen::AlignedBox3d& middle = lung_box_.isEmpty() ? bone_box_ : lung_box_;
    if (!middle.isEmpty()) found_.isocentre = middle.center();
    if (bones_.empty()) return found_;
    const Mesh trunk = TrunkOutline(bones_, bone_box_.min().z(), bone_box_.max().z());
    found_.all.push_back({"trunk", trunk.vertices, trunk.triangles, CoefficientOf(Tissue::kWall)});
    return found_;
  }

 private:
  static void Extend(Eigen::AlignedBox3d& box, const Points& vertices) {
    for (const auto& vertex : vertices.colwise()) box.extend(Eigen::Vector3d(vertex));
  }

  void AddClosed(const BodyModel& body, Tissue tissue, const Points& placed, const Triangles& triangles) {
    if (tissue == Tissue::kLung) {
      const double rest = SignedVolume(body.mesh.vertices, triangles), now = SignedVolume(placed, triangles);
      found_.lungs.push_back({body.name, LungDensity(rest, now)});
      found_.all.push_back({body.name, placed, triangles, LungCoefficient(rest, now) - outside_});
    } else if (tissue == Tissue::kRib) {
      const double cortical = CoefficientOf(Tissue::kCortical), marrow = CoefficientOf(Tissue::kMarrow);
      found_.all.push_back({body.name, placed, triangles, cortical - outside_});
      if (body.skin >= 0 || body.first_vertex >= 0) return;  // a rib that bends is one solid
      const Points inside = placed - kShell * VertexNormals(placed, triangles);
      found_.all.push_back({body.name, inside, triangles, marrow - cortical});
    } else {
      found_.all.push_back({body.name, placed, triangles, CoefficientOf(tissue) - outside_});
    }
  }

  const Model& model_;
  const State& state_;
  const std::vector<std::optional<Tissue>> tissues_;  // of the model's bodies
  double outside_ = 0;  // coefficient of what is around the bodies [1/m]: the trunk's tissue, or nothing without bones
  Absorbers found_;
  std::vector<Points> bones_;
  Eigen::AlignedBox3d bone_box_, lung_box_;  // at rest
};

}  // namespace

std::vector<std::optional<Tissue>> TissuesOf(const Model& model) {
  std::vector<std::optional<Tissue>> tissues;
  bool has_lung = false;  // as a whole
  for (const BodyModel& body : model.bodies) {
    tissues.push_back(TissueOfBody(body));
    has_lung = has_lung || (tissues.back() == Tissue::kLung && !IsLobe(body.name));
  }
  for (std::size_t b = 0; has_lung && b < tissues.size(); ++b) {
    if (IsLobe(model.bodies[b].name)) tissues[b] = std::nullopt;
  }
  return tissues;
}

absl::StatusOr<Absorbers> AbsorbersAt(const Model& model, const State& state) {
  Collector collector(model, state);
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) collector.Add(b);
  Absorbers found = collector.Finish();
  if (!found.all.empty()) return found;
  return absl::FailedPreconditionError(
      "no body of the scene has a tissue that absorbs X-rays: names or layers such as rib, t8, lung or heart tell it");
}

}  // namespace phrenic::fluoroscopy
