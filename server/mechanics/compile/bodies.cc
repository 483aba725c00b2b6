#include "server/mechanics/compile/bodies.h"

#include <set>

#include "absl/strings/str_cat.h"
#include "server/mechanics/compile/masses.h"
#include "server/mechanics/compile/shapes.h"
#include "server/mesh/nearest.h"

namespace phrenic {
namespace {

constexpr double kFurthest = 10;     // margin of Model::bound, in sizes of the scene
constexpr double kSizeOfAPoint = 1;  // size of a scene without extent [m], so that bound leaves room for motion
constexpr double kRounding = 1e-9;   // tolerance of boxes, so that they include vertices on their faces [m]

std::string RoleName(v1::Role role) {
  switch (role) {
    case v1::ROLE_DEFORMABLE:
      return "deformable";
    case v1::ROLE_DRIVEN:
      return "driven";
    case v1::ROLE_AT_REST:
      return "at rest";
    default:
      return "seen";
  }
}

// Adds the scene's named vertex sets to those of the mesh.
absl::Status AddRegions(const v1::Body& scene, std::string_view path, Mesh& mesh) {
  for (int r = 0; r < scene.regions_size(); ++r) {
    const v1::Region& region = scene.regions(r);
    const Eigen::Array3d low = ToEigen(region.low()), high = ToEigen(region.high());
    std::vector<int> vertices;
    for (int i = 0; i < mesh.vertices.cols(); ++i) {
      const Eigen::Array3d x = mesh.vertices.col(i);
      if ((x >= low - kRounding).all() && (x <= high + kRounding).all()) vertices.push_back(i);
    }
    const std::string field = absl::StrCat(std::string(path), ".regions[", r, "]");
    if (vertices.empty()) return FieldError(field, "contains no vertex of the body at rest");
    if (!mesh.regions.emplace(region.name(), std::move(vertices)).second) {
      return FieldError(field, absl::StrCat("there are two regions named \"", region.name(), "\""));
    }
  }
  return absl::OkStatus();
}

void Fix(int vertex, Model& model) {
  if (model.inverse_mass[vertex] == 0) return;
  model.inverse_mass[vertex] = 0;
  model.fixed_vertices.push_back(vertex);
}

absl::Status FixRegions(const v1::Body& scene, std::string_view path, const BodyModel& body, Model& model) {
  for (int r = 0; r < scene.fixed_regions_size(); ++r) {
    const auto found = body.mesh.regions.find(scene.fixed_regions(r));
    if (found == body.mesh.regions.end()) {
      return FieldError(absl::StrCat(std::string(path), ".fixed_regions[", r, "]"),
                        absl::StrCat("the body has no region \"", scene.fixed_regions(r), "\""));
    }
    for (const int vertex : found->second) Fix(body.first_vertex + vertex, model);
  }
  return absl::OkStatus();
}

absl::Status AddSimulated(const v1::Body& scene, std::string_view path, BodyModel& body, Model& model) {
  const Eigen::Index first = model.rest.cols(), n = body.mesh.vertices.cols();
  const auto masses = VertexMasses(scene, body.mesh, path);
  if (!masses.ok()) return masses.status();
  body.first_vertex = static_cast<int>(first);
  model.rest.conservativeResize(3, first + n);
  model.rest.rightCols(n) = body.mesh.vertices;
  model.mass.conservativeResize(first + n);
  model.mass.tail(n) = *masses;
  model.inverse_mass.conservativeResize(first + n);
  model.inverse_mass.tail(n) = model.mass.tail(n).cwiseInverse();
  for (int i = 0; i < scene.fixed_vertices_size(); ++i) {
    const int vertex = scene.fixed_vertices(i);
    if (vertex < 0 || vertex >= n) {
      return FieldError(absl::StrCat(std::string(path), ".fixed_vertices[", i, "]"),
                        absl::StrCat("there is no vertex ", vertex, ": the body's vertices are 0 to ", n - 1));
    }
    Fix(static_cast<int>(first) + vertex, model);
  }
  return FixRegions(scene, path, body, model);
}

void Report(const BodyModel& body, const v1::Body& scene, v1::CompileReport& report) {
  v1::BodyReport* row = report.add_bodies();
  const Mesh& mesh = body.mesh;
  const Eigen::Index corners = mesh.triangles.cols();
  row->set_name(body.name);
  row->set_layer(body.layer);
  row->set_role(RoleName(scene.role()));
  row->set_vertices(mesh.vertices.cols());
  row->set_edges(mesh.edges.cols() > 0 ? mesh.edges.cols() : corners * 3 / 2);
  row->set_triangles(corners);
  row->set_simulated_vertices(body.first_vertex >= 0 ? mesh.vertices.cols() : 0);
}

void SetSize(Model& model) {
  Eigen::Vector3d low = model.bodies.front().mesh.vertices.col(0), high = low;
  for (const BodyModel& body : model.bodies) {
    low = low.cwiseMin(body.mesh.vertices.rowwise().minCoeff());
    high = high.cwiseMax(body.mesh.vertices.rowwise().maxCoeff());
  }
  model.size = (high - low).norm();
  if (model.size == 0) model.size = kSizeOfAPoint;
  model.bound = low.cwiseAbs().cwiseMax(high.cwiseAbs()).maxCoeff() + kFurthest * model.size;
}

// Vertices closer to the midline than this fraction of the body's width belong to no side. Otherwise the highest vertex
// of the lower dome would be where it adjoins the higher one.
constexpr double kMiddlePart = 1.0 / 6;

// Returns the highest vertex on that side; -1 if there is none.
int HighestOn(v1::Side side, const Points& vertices) {
  const double width = vertices.row(0).maxCoeff() - vertices.row(0).minCoeff();
  const double outward = side == v1::SIDE_LEFT ? 1 : -1;
  int highest = -1;
  for (int i = 0; i < vertices.cols(); ++i) {
    if (outward * vertices(0, i) <= kMiddlePart * width) continue;
    if (highest < 0 || vertices(2, i) > vertices(2, highest)) highest = i;
  }
  return highest;
}

absl::StatusOr<int> ProbeVertex(const v1::Probe& probe, int body, const std::string& path,
                                const ModelBuilder& builder) {
  const Points& vertices = builder.model.bodies[body].mesh.vertices;
  int vertex = -1;
  switch (probe.where_case()) {
    case v1::Probe::kVertex: {
      absl::Status status = builder.CheckVertex(body, probe.vertex(), path + ".vertex");
      if (!status.ok()) return status;
      return probe.vertex();
    }
    case v1::Probe::kNearestTo:
      return builder.Search(body).Nearest(ToEigen(probe.nearest_to())).vertex;
    case v1::Probe::kHighestOn:
      vertex = HighestOn(probe.highest_on(), vertices);
      if (vertex < 0) return FieldError(path + ".highest_on", "the body has no vertex on that side");
      return vertex;
    case v1::Probe::WHERE_NOT_SET:
      break;
  }
  return FieldError(path, "has no position: set vertex, nearest_to or highest_on");
}

}  // namespace

absl::Status AddBodies(const MeshSource& source, const SizeLimits& limits, ModelBuilder& builder) {
  Model& model = builder.model;
  std::set<std::string> names;
  std::vector<MeshSize> sizes(static_cast<std::size_t>(model.scene.bodies_size()));
  std::int64_t vertices = 0;
  int poses = 0;
  for (int b = 0; b < model.scene.bodies_size(); ++b) {
    const v1::Body& scene = model.scene.bodies(b);
    const std::string path = absl::StrCat("bodies[", b, "]");
    if (!names.insert(scene.name()).second) {
      return FieldError(path + ".name", absl::StrCat("there are two bodies named \"", scene.name(), "\""));
    }
    absl::StatusOr<Mesh> mesh = MakeShape(scene, source, builder.stop);
    if (!mesh.ok()) return mesh.status();
    sizes[static_cast<std::size_t>(b)] = SizeOf(*mesh);
    vertices += mesh->vertices.cols();
    if (vertices > limits.vertices) return CountSize(model.scene, sizes, limits).status();
    if (absl::Status status = AddRegions(scene, path, *mesh); !status.ok()) return status;
    BodyModel body{.name = scene.name(),
                   .layer = scene.layer(),
                   .role = scene.role(),
                   .anatomy = scene.anatomy(),
                   .mesh = *std::move(mesh)};
    if (scene.role() == v1::ROLE_DRIVEN) body.pose = poses++;
    if (scene.role() == v1::ROLE_DEFORMABLE) {
      if (absl::Status status = AddSimulated(scene, path, body, model); !status.ok()) return status;
    }
    Report(body, scene, model.report);
    model.bodies.push_back(std::move(body));
  }
  model.report.set_simulated_vertices(model.rest.cols());
  SetSize(model);
  return CountSize(model.scene, sizes, limits).status();
}

absl::Status AddProbes(ModelBuilder& builder) {
  for (int p = 0; p < builder.model.scene.probes_size(); ++p) {
    const v1::Probe& probe = builder.model.scene.probes(p);
    const std::string path = absl::StrCat("probes[", p, "]");
    auto body = builder.Body(probe.body(), path + ".body");
    if (!body.ok()) return body.status();
    auto vertex = ProbeVertex(probe, *body, path, builder);
    if (!vertex.ok()) return vertex.status();
    builder.model.probes.push_back({probe.name(), *body, *vertex});
  }
  return absl::OkStatus();
}

}  // namespace phrenic
