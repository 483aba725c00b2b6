#include "server/mechanics/skinning/triangle_skin.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "server/mechanics/skinning/driver_triangles.h"
#include "server/mesh/units.h"

namespace phrenic {
namespace {

constexpr double kStretch = 0.01;  // the strain for which the report states the error

// Returns the largest position error [m] of a point at height h under a stretch F = I + s d d^T of the triangles: the
// height keeps its length and rotates with the normal, so that the error is s h |2 c d - c^2 n|, c = n.d, whose maximum
// is 2/sqrt(3) s h.
double LargestStretchError(double height) { return 2 / std::sqrt(3.0) * kStretch * std::abs(height); }

}  // namespace

absl::StatusOr<TriangleBinder> TriangleBinder::Make(const ModelBuilder& builder, const std::vector<int>& drivers,
                                                    std::string_view path) {
  const absl::StatusOr<Triangles> triangles = DriverTriangles(builder, drivers, path);
  if (!triangles.ok()) return triangles.status();
  return TriangleBinder(builder, *triangles);
}

TriangleBinder::TriangleBinder(const ModelBuilder& builder, const Triangles& triangles)
    : builder_(builder), tree_(builder.model.rest, triangles) {
  tree_.Fit(builder.model.rest, boxes_);
}

Skin TriangleBinder::Bind(int body, v1::MappingReport& report) const {
  const BodyModel& seen = builder_.model.bodies[body];
  const ConstPoints x = builder_.model.rest;
  Skin skin{.body = body, .weights = {}, .triangles = {}, .sheet = nullptr};
  double sum = 0, furthest = 0, highest = 0;
  for (Eigen::Index i = 0; i < seen.mesh.vertices.cols() && !builder_.stop.Stopped(); ++i) {
    const Eigen::Vector3d point = seen.mesh.vertices.col(i);
    const SurfacePoint nearest = tree_.Nearest(x, boxes_, point, std::numeric_limits<double>::infinity());
    skin.triangles.push_back(BindToPlane(x, tree_.triangle(nearest.triangle), point));
    sum += nearest.offset.norm();
    furthest = std::max(furthest, nearest.offset.norm());
    highest = std::max(highest, std::abs(skin.triangles.back().height));
  }
  report.set_body(seen.name);
  report.set_mean_distance_mm(kMillimetresAMetre * sum / static_cast<double>(seen.mesh.vertices.cols()));
  report.set_largest_distance_mm(kMillimetresAMetre * furthest);
  report.set_largest_strain_error_mm(kMillimetresAMetre * LargestStretchError(highest));
  return skin;
}

}  // namespace phrenic
