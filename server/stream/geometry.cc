#include "server/stream/geometry.h"

#include <algorithm>

#include "server/stream/codecs/wire.h"

namespace phrenic::stream {
namespace {

constexpr char kPlainColor[] = "#c8c8c8";
constexpr char kTemplateRegion[] = "from-template";  // of a patient's surface (imaging/patient/template_parts.h)

void SetLook(const Model& model, const BodyModel& body, v1::GetGeometryResponse& geometry) {
  geometry.set_name(body.name);
  geometry.set_layer(body.layer.empty() ? body.name : body.layer);
  geometry.set_layer_title(geometry.layer());
  geometry.set_color(kPlainColor);
  geometry.set_opacity(1);
  for (const v1::Layer& layer : model.scene.layers()) {
    if (layer.name() != body.layer) continue;
    if (!layer.title().empty()) geometry.set_layer_title(layer.title());
    if (!layer.color().empty()) geometry.set_color(layer.color());
    if (layer.has_opacity()) geometry.set_opacity(layer.opacity());
  }
}

void SetSurface(const BodyModel& body, v1::GetGeometryResponse& geometry) {
  const Eigen::MatrixXf rest = body.mesh.vertices.cast<float>();
  AppendFloats(rest, *geometry.mutable_rest_positions());
  AppendIndices(body.mesh.triangles, *geometry.mutable_triangles());
  AppendIndices(body.mesh.edges, *geometry.mutable_edges());
  const auto filled = body.mesh.regions.find(kTemplateRegion);
  if (filled == body.mesh.regions.end()) return;
  for (const int vertex : filled->second) AppendIndex(vertex, *geometry.mutable_template_vertices());
}

// Converts overlays from simulated vertices to the body's vertex numbers.
void SetOverlays(const Model& model, const BodyModel& body, v1::GetGeometryResponse& geometry) {
  if (body.first_vertex < 0) return;
  const int first = body.first_vertex;
  const int last = first + static_cast<int>(body.mesh.vertices.cols());
  const auto mine = [&](int vertex) { return first <= vertex && vertex < last; };
  for (Eigen::Index i = 0; i < model.rigid_links.cols(); ++i) {
    if (!mine(model.rigid_links(0, i)) || !mine(model.rigid_links(1, i))) continue;
    AppendIndex(model.rigid_links(0, i) - first, *geometry.mutable_rigid_links());
    AppendIndex(model.rigid_links(1, i) - first, *geometry.mutable_rigid_links());
  }
  for (int vertex : model.attached_vertices) {
    if (mine(vertex)) AppendIndex(vertex - first, *geometry.mutable_attached_vertices());
  }
  for (int vertex : model.fixed_vertices) {
    if (mine(vertex)) AppendIndex(vertex - first, *geometry.mutable_fixed_vertices());
  }
}

// A line is drawn from its origin to the end of the body along its direction; to twice the radius if it misses it.
double LineLength(const ActionLineView& line, const ConstPoints& vertices) {
  double length = 2 * line.radius;
  for (Eigen::Index i = 0; i < vertices.cols(); ++i) {
    const Eigen::Vector3d offset = vertices.col(i) - line.origin;
    const double along = offset.dot(line.direction);
    if ((offset - along * line.direction).norm() <= line.radius) length = std::max(length, along);
  }
  return length;
}

void SetActionLines(const Model& model, int body, v1::GetGeometryResponse& geometry) {
  for (const ActionLineView& line : model.action_lines) {
    if (line.body != body) continue;
    v1::ActionLineGeometry& drawn = *geometry.add_action_lines();
    drawn.set_name(line.name);
    for (int axis = 0; axis < 3; ++axis) {
      drawn.add_origin(line.origin[axis]);
      drawn.add_direction(line.direction[axis]);
    }
    drawn.set_radius(line.radius);
    drawn.set_length(LineLength(line, model.bodies[body].mesh.vertices));
  }
}

}  // namespace

v1::GetGeometryResponse MakeGeometry(const Model& model, const Layout& layout, int index) {
  const BodyModel& body = model.bodies[index];
  v1::GetGeometryResponse geometry;
  geometry.set_body_count(static_cast<int>(model.bodies.size()));
  geometry.set_body_index(index);
  geometry.set_placement(layout.placement(index));
  geometry.set_pose(std::max(0, body.pose));
  geometry.set_first_vertex(layout.first_vertex(index));
  SetLook(model, body, geometry);
  SetSurface(body, geometry);
  SetOverlays(model, body, geometry);
  SetActionLines(model, index, geometry);
  return geometry;
}

}  // namespace phrenic::stream
