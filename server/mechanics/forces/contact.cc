#include "server/mechanics/forces/contact.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace phrenic {
namespace {

// Scratch memory: the bounding boxes of the deformable surface being evaluated.
struct FittedBoxes {
  TriangleTree::Boxes boxes;
};

constexpr double kReach = 10;      // largest penetration [depths]
constexpr double kGravity = 9.81;  // [m/s^2]

absl::StatusOr<std::vector<int>> SurfaceBodies(const v1::Contact& scene, const std::vector<int>& bodies,
                                               std::string_view path, const ModelBuilder& builder) {
  const std::string field = absl::StrCat(std::string(path), ".surfaces");
  auto surfaces = builder.Bodies(scene.surfaces(), field);
  if (!surfaces.ok()) return surfaces;
  for (const int s : *surfaces) {
    const BodyModel& body = builder.model.bodies[s];
    const auto error = [&](const char* what) { return FieldError(field, absl::StrCat("body \"", body.name, what)); };
    if (body.mesh.triangles.cols() == 0) return error("\" has no triangles and cannot be a contact surface");
    if (body.skin >= 0)
      return error("\" is only seen and follows other bodies: name a body that is deformable, driven or at rest");
    if (std::find(bodies.begin(), bodies.end(), s) != bodies.end()) {
      return error("\" is also in bodies: self-contact is not supported");
    }
  }
  return surfaces;
}

double Load(const v1::Contact& scene, const std::vector<int>& bodies, const Model& model) {
  if (scene.has_load()) return scene.load();
  double heaviest = 0;
  for (const int b : bodies) {
    const BodyModel& body = model.bodies[b];
    heaviest = std::max(heaviest, model.mass.segment(body.first_vertex, body.mesh.vertices.cols()).sum());
  }
  return kGravity * heaviest;
}

}  // namespace

absl::StatusOr<std::unique_ptr<Force>> Contact::Make(const v1::Contact& scene, const std::string& given,
                                                     std::string_view path, ModelBuilder& builder) {
  const std::string name = ElementName(given, "contact", scene.bodies());
  auto bodies = builder.DeformableBodies(scene.bodies(), absl::StrCat(std::string(path), ".bodies"));
  if (!bodies.ok()) return bodies.status();
  auto surfaces = SurfaceBodies(scene, *bodies, path, builder);
  if (!surfaces.ok()) return surfaces.status();
  std::unique_ptr<Contact> force(new Contact(name));
  for (const int b : *bodies) {
    const BodyModel& body = builder.model.bodies[b];
    for (int i = 0; i < body.mesh.vertices.cols(); ++i) force->vertices_.push_back(body.first_vertex + i);
  }
  for (const int s : *surfaces) force->surfaces_.push_back(MakeSurface(builder.model.bodies[s]));
  force->stiffness_ = Load(scene, *bodies, builder.model) / scene.depth();
  force->reach_ = kReach * scene.depth();
  builder.ReportElement("force", name, static_cast<std::int64_t>(force->vertices_.size()), "vertices",
                        absl::StrFormat("on %d surfaces, penetration %g mm at the load, k = %g N/m", surfaces->size(),
                                        1e3 * scene.depth(), force->stiffness_));
  return force;
}

Contact::Surface Contact::MakeSurface(const BodyModel& body) {
  Surface surface{TriangleTree(body.mesh.vertices, body.mesh.triangles), {},       {}, body.first_vertex,
                  static_cast<int>(body.mesh.vertices.cols()),           body.pose};
  if (surface.deformable()) return surface;
  surface.rest = body.mesh.vertices;
  surface.tree.Fit(surface.rest, surface.boxes);
  return surface;
}

template <typename Visitor>
void Contact::ForEachTouch(const EvalContext& at, const Visitor& visit) const {
  TriangleTree::Boxes& fitted = at.scratch.Get<FittedBoxes>().boxes;
  for (const Surface& surface : surfaces_) {
    const bool deformable = surface.deformable();
    const ConstPoints x =
        deformable ? ConstPoints(at.x.middleCols(surface.first_vertex, surface.vertices)) : ConstPoints(surface.rest);
    if (deformable) surface.tree.Fit(x, fitted);
    const TriangleTree::Boxes& boxes = deformable ? fitted : surface.boxes;
    const Pose pose = surface.pose >= 0 ? at.poses[surface.pose] : Pose{};
    const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
    for (const int vertex : vertices_) {
      const Eigen::Vector3d point = rotation.transpose() * (at.x.col(vertex) - pose.translation);
      const SurfacePoint nearest = surface.tree.Nearest(x, boxes, point, reach_);
      if (nearest.triangle < 0 || nearest.facing <= 0 || nearest.on_boundary) continue;
      const Eigen::Vector3i corners = surface.tree.triangle(nearest.triangle).array() + surface.first_vertex;
      visit(Touch{vertex, rotation * nearest.offset, &surface, corners, nearest.weights});
    }
  }
}

void Contact::AddForce(const EvalContext& at, MutablePoints f) const {
  ForEachTouch(at, [&](const Touch& touch) {
    const Eigen::Vector3d push = stiffness_ * touch.offset;
    f.col(touch.vertex) += push;
    if (!touch.surface->deformable()) return;
    for (int i = 0; i < 3; ++i) f.col(touch.corners[i]) -= touch.weights[i] * push;
  });
}

// K = k g g^T, g the derivative of the penetration: the normal times 1 at the vertex and times minus the barycentric
// weights at the corners.
void Contact::AddStiffness(const EvalContext& at, StiffnessSink& sink) const {
  ForEachTouch(at, [&](const Touch& touch) {
    const Eigen::Vector3d normal = touch.offset.normalized();
    const Eigen::Matrix3d block = stiffness_ * normal * normal.transpose();
    sink.Add(touch.vertex, touch.vertex, block);
    if (!touch.surface->deformable()) return;
    for (int i = 0; i < 3; ++i) {
      sink.Add(touch.vertex, touch.corners[i], -touch.weights[i] * block);
      sink.Add(touch.corners[i], touch.vertex, -touch.weights[i] * block);
      for (int j = 0; j < 3; ++j)
        sink.Add(touch.corners[i], touch.corners[j], touch.weights[i] * touch.weights[j] * block);
    }
  });
}

// Assumes one contact at each vertex of the bodies and one at each vertex of a deformable surface; twice the stiffness
// where both sides move.
void Contact::AddLatentStiffness(const EvalContext&, StiffnessSink& sink) const {
  const bool deformable =
      std::any_of(surfaces_.begin(), surfaces_.end(), [](const Surface& surface) { return surface.deformable(); });
  const Eigen::Matrix3d block = (deformable ? 2 : 1) * stiffness_ * Eigen::Matrix3d::Identity();
  for (const int vertex : vertices_) sink.Add(vertex, vertex, block);
  for (const Surface& surface : surfaces_) {
    for (int i = 0; surface.deformable() && i < surface.vertices; ++i) {
      sink.Add(surface.first_vertex + i, surface.first_vertex + i, block);
    }
  }
}

double Contact::Energy(const EvalContext& at) const {
  double energy = 0;
  ForEachTouch(at, [&](const Touch& touch) { energy += 0.5 * stiffness_ * touch.offset.squaredNorm(); });
  return energy;
}

}  // namespace phrenic
