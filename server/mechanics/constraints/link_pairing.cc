#include "server/mechanics/constraints/link_pairing.h"

#include "absl/strings/str_cat.h"
#include "server/mesh/nearest.h"
#include "server/mesh/normals.h"
#include "server/mesh/topology.h"

namespace phrenic {
namespace {

struct Plane {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // zero: all points count as above
  bool Above(const Eigen::Vector3d& x) const { return normal.isZero() || (x - point).dot(normal) > 0; }
};

absl::StatusOr<Plane> PlaneOfVertices(const v1::LinkPairing& scene, int body, std::string_view path,
                                      const ModelBuilder& builder) {
  const std::string field = absl::StrCat(std::string(path), ".plane_vertices");
  if (scene.plane_vertices_size() != 3) return FieldError(field, "must list three vertices to define a plane");
  for (const int vertex : scene.plane_vertices()) {
    if (absl::Status status = builder.CheckVertex(body, vertex, field); !status.ok()) return status;
  }
  const Points& x = builder.model.bodies[body].mesh.vertices;
  const Eigen::Vector3d a = x.col(scene.plane_vertices(0));
  const Eigen::Vector3d b = x.col(scene.plane_vertices(1)), c = x.col(scene.plane_vertices(2));
  Eigen::Vector3d normal = (b - a).cross(c - a);
  if (normal.norm() == 0) return FieldError(field, "the three vertices are collinear and define no plane");
  if (normal.z() < 0) normal = -normal;
  return Plane{a, normal.normalized()};
}

absl::StatusOr<Plane> MakePlane(const v1::LinkPairing& scene, int body, std::string_view path,
                                const ModelBuilder& builder) {
  if (scene.plane_vertices_size() > 0) return PlaneOfVertices(scene, body, path, builder);
  if (!scene.has_plane_normal()) return Plane{};
  const Eigen::Vector3d normal = ToEigen(scene.plane_normal());
  if (normal.isZero()) return FieldError(absl::StrCat(std::string(path), ".plane_normal"), "must not be zero");
  return Plane{ToEigen(scene.plane_point()), normal.normalized()};
}

}  // namespace

absl::StatusOr<Edges> PairLinks(const v1::LinkPairing& scene, int b, std::string_view path,
                                const ModelBuilder& builder) {
  const Mesh& mesh = builder.model.bodies[b].mesh;
  const auto plane = MakePlane(scene, b, path, builder);
  if (!plane.ok()) return plane.status();
  const auto region = builder.Region(b, scene.region(), absl::StrCat(std::string(path), ".region"));
  if (!region.ok()) return region.status();
  const Points normals = VertexNormals(mesh.vertices, mesh.triangles);
  const NearestSearch& search = builder.Search(b);
  std::vector<bool> free = *region;
  for (size_t i = 0; i < free.size(); ++i) {
    free[i] = free[i] && plane->Above(mesh.vertices.col(static_cast<Eigen::Index>(i)));
  }
  std::vector<std::pair<int, int>> pairs;
  for (int i = 0; i < mesh.vertices.cols() && !builder.stop.Stopped(); ++i) {
    if (!free[i]) continue;
    for (const Neighbour& other : search.Within(mesh.vertices.col(i), scene.distance())) {
      const int j = other.vertex;
      if (j == i || !free[j] || normals.col(i).dot(normals.col(j)) > 0 || other.distance == 0) continue;
      pairs.emplace_back(i, j);
      free[i] = free[j] = false;
      break;
    }
  }
  return ToEdges(pairs);
}

}  // namespace phrenic
