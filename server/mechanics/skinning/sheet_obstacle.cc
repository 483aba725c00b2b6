#include "server/mechanics/skinning/sheet_obstacle.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "absl/strings/str_cat.h"
#include "server/mechanics/parallel/compile_threads.h"
#include "server/mechanics/skinning/driver_triangles.h"

namespace phrenic {
namespace {

constexpr double kClearance = 0.001;     // [m]
constexpr double kObstacleReach = 0.06;  // of the search at rest [m]
constexpr double kLeastFacing = 0.7071;  // least |cos| of the angle between offset and normal
constexpr double kHeightSlope = 0.5;     // height over a plane that a vertex may lose by sliding along it
constexpr double kHeightSlack = 1e-4;    // of the height over the plane [m]
constexpr double kOnSurface = 1e-9;      // [m]

struct SheetTriangle {
  Eigen::Vector3d a, b, c;
  SheetTriangle(const ConstPoints& x, const Eigen::Vector3i& t) : a(x.col(t[0])), b(x.col(t[1])), c(x.col(t[2])) {}
  Eigen::Vector3d At(const Eigen::Vector3d& weights) const { return weights[0] * a + weights[1] * b + weights[2] * c; }
  Eigen::Vector3d Area() const { return (b - a).cross(c - a); }  // twice that of the triangle [m^2]
  Eigen::Vector3d Normal() const { return Area().stableNormalized(); }
};

bool HasSide(const SurfacePoint& nearest) {
  return nearest.triangle >= 0 && !nearest.on_boundary &&
         (std::abs(nearest.facing) > kLeastFacing || nearest.squared < kOnSurface * kOnSurface);
}

// Positive in front [m].
double SignedDistance(const SurfacePoint& nearest) {
  const double distance = std::sqrt(nearest.squared);
  return nearest.facing > 0 ? -distance : distance;
}

}  // namespace

Obstacle::Obstacle(const ModelBuilder& builder, const Triangles& triangles)
    : first_vertex(triangles.minCoeff()),
      vertices(triangles.maxCoeff() + 1 - first_vertex),
      tree(builder.model.rest.middleCols(first_vertex, vertices), triangles.array() - first_vertex),
      walk(tree) {}

SheetObstacle::SheetObstacle(std::shared_ptr<const Obstacle> obstacle, const ModelBuilder& builder, const Points& rest)
    : obstacle_(std::move(obstacle)) {
  const ConstPoints sheet = builder.model.rest.middleCols(obstacle_->first_vertex, obstacle_->vertices);
  TriangleTree::Boxes boxes;
  obstacle_->tree.Fit(sheet, boxes);
  std::vector<Vertex> found(static_cast<size_t>(rest.cols()));
  const auto stopped = [&builder] { return builder.stop.Stopped(); };
  ForEachPartUntil(CountParts(rest.cols()), stopped, [&](std::int64_t part) {
    const PartRange range = PartOf(rest.cols(), part);
    for (std::int64_t i = range.first; i < range.end; ++i) {
      const SurfacePoint nearest = obstacle_->tree.Nearest(sheet, boxes, rest.col(i), kObstacleReach);
      if (!HasSide(nearest) || nearest.facing > 0) continue;
      found[i] = {static_cast<int>(i), nearest.triangle, nearest.weights,
                  std::min(kClearance, SignedDistance(nearest))};
    }
  });
  std::erase_if(found, [](const Vertex& vertex) { return !(vertex.least > 0); });
  vertices_ = std::move(found);
}

bool SheetObstacle::IsNear(const ConstPoints& sheet, const Vertex& vertex, const Eigen::Vector3d& point) const {
  const SheetTriangle triangle(sheet, obstacle_->tree.triangle(vertex.triangle));
  const Eigen::Vector3d offset = point - triangle.At(vertex.foot), area = triangle.Area();
  const double above = offset.dot(area), squared = area.squaredNorm(), least = vertex.least + kHeightSlack;
  // Most vertices are far: (least + slope slid)^2 <= 2 (least^2 + slope^2 |offset|^2).
  const double most = 2 * (least * least + kHeightSlope * kHeightSlope * offset.squaredNorm());
  if (above > 0 && above * above > squared * most) return false;
  const double height = above / std::sqrt(squared);
  const double slid = std::sqrt(std::max(0.0, offset.squaredNorm() - height * height));
  return !(height >= least + kHeightSlope * slid);
}

template <typename Correct>
void SheetObstacle::ForEachBehind(const ConstPoints& sheet, const MutablePoints& x, const Correct& correct) const {
  for (const Vertex& vertex : vertices_) {
    const Eigen::Vector3d point = x.col(vertex.index);
    if (!IsNear(sheet, vertex, point)) continue;
    const SurfacePoint nearest = obstacle_->walk.Nearest(sheet, point, vertex.triangle);
    const double distance = SignedDistance(nearest);
    if (!HasSide(nearest) || distance >= vertex.least) continue;
    const Eigen::Vector3d outward = std::abs(distance) > kOnSurface
                                        ? Eigen::Vector3d(-nearest.offset / distance)
                                        : SheetTriangle(sheet, obstacle_->tree.triangle(nearest.triangle)).Normal();
    correct(vertex.index, nearest, outward, vertex.least - distance);
  }
}

void SheetObstacle::Place(const EvalContext& at, MutablePoints x) const {
  const ConstPoints sheet = at.x.middleCols(obstacle_->first_vertex, obstacle_->vertices);
  ForEachBehind(sheet, x, [&](int i, const SurfacePoint&, const Eigen::Vector3d& outward, double way) {
    x.col(i) += way * outward;
  });
}

void SheetObstacle::Move(const EvalContext& at, MutablePoints x, MutablePoints v) const {
  const ConstPoints sheet = at.x.middleCols(obstacle_->first_vertex, obstacle_->vertices);
  const ConstPoints rates = at.v.middleCols(obstacle_->first_vertex, obstacle_->vertices);
  ForEachBehind(sheet, x, [&](int i, const SurfacePoint& nearest, const Eigen::Vector3d& outward, double way) {
    const Eigen::Vector3d rate = SheetTriangle(rates, obstacle_->tree.triangle(nearest.triangle)).At(nearest.weights);
    x.col(i) += way * outward;
    v.col(i) += outward * outward.dot(rate - v.col(i));
  });
}

absl::Status AddObstacle(const v1::Skin& scene, std::string_view path, ModelBuilder& builder) {
  if (scene.obstacle().empty()) return absl::OkStatus();
  const std::string field = absl::StrCat(std::string(path), ".obstacle");
  const auto bodies = builder.Bodies(scene.bodies(), path);
  if (!bodies.ok()) return bodies.status();
  const auto body = builder.Body(scene.obstacle(), field);
  if (!body.ok()) return body.status();
  if (builder.model.bodies[*body].first_vertex < 0) {
    return FieldError(field, absl::StrCat("body \"", scene.obstacle(), "\" must have ROLE_DEFORMABLE; name the sheet"));
  }
  const auto triangles = DriverTriangles(builder, {*body}, field);
  if (!triangles.ok()) return triangles.status();
  const auto obstacle = std::make_shared<const Obstacle>(builder, *triangles);
  for (const int b : *bodies) {
    const BodyModel& seen = builder.model.bodies[b];
    builder.model.skins[seen.skin].corrections.push_back(
        std::make_shared<SheetObstacle>(obstacle, builder, seen.mesh.vertices));
  }
  return absl::OkStatus();
}

}  // namespace phrenic
