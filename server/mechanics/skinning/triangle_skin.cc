#include "server/mechanics/skinning/triangle_skin.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "absl/strings/str_cat.h"
#include "server/mesh/units.h"

namespace phrenic {
namespace {

constexpr double kNoArea = 1e-9;   // relative to the longest edge squared: smaller triangles count as degenerate
constexpr double kStretch = 0.01;  // the strain for which the report states the error

// Returns twice the triangle's area times its unit normal [m^2].
Eigen::Vector3d AreaVector(const ConstPoints& x, const Eigen::Vector3i& t) {
  const Eigen::Vector3d a = x.col(t[0]), b = x.col(t[1]), c = x.col(t[2]);
  return (b - a).cross(c - a);
}

bool HasArea(const ConstPoints& x, const Eigen::Vector3i& t) {
  const double longest = std::max({(x.col(t[0]) - x.col(t[1])).squaredNorm(), (x.col(t[1]) - x.col(t[2])).squaredNorm(),
                                   (x.col(t[2]) - x.col(t[0])).squaredNorm()});
  return AreaVector(x, t).norm() > kNoArea * longest;
}

void AddTriangles(const ModelBuilder& builder, const BodyModel& body, std::vector<Eigen::Vector3i>& triangles) {
  for (Eigen::Index t = 0; t < body.mesh.triangles.cols(); ++t) {
    const Eigen::Vector3i corners = body.mesh.triangles.col(t).array() + body.first_vertex;
    if (HasArea(builder.model.rest, corners)) triangles.push_back(corners);
  }
}

// Returns barycentric coordinates and height of a point relative to a triangle. Exact for points outside it too.
TriangleBinding BindTo(const ConstPoints& x, const Eigen::Vector3i& t, const Eigen::Vector3d& point) {
  const Eigen::Vector3d area = AreaVector(x, t);
  const Eigen::Vector3d a = x.col(t[0]), b = x.col(t[1]), c = x.col(t[2]);
  const double squared = area.squaredNorm();
  const double of_b = area.dot((point - a).cross(c - a)) / squared, of_c = area.dot((b - a).cross(point - a)) / squared;
  return {t, {1 - of_b - of_c, of_b, of_c}, area.dot(point - a) / std::sqrt(squared)};
}

// Returns the largest position error [m] of a point at height h under a stretch F = I + s d d^T of the triangles: the
// height keeps its length and rotates with the normal, so that the error is s h |2 c d - c^2 n|, c = n.d, whose maximum
// is 2/sqrt(3) s h.
double LargestStretchError(double height) { return 2 / std::sqrt(3.0) * kStretch * std::abs(height); }

}  // namespace

absl::StatusOr<TriangleBinder> TriangleBinder::Make(const ModelBuilder& builder, const std::vector<int>& drivers,
                                                    std::string_view path) {
  std::vector<Eigen::Vector3i> triangles;
  for (const int c : drivers) {
    const BodyModel& body = builder.model.bodies[c];
    const size_t before = triangles.size();
    if (body.first_vertex >= 0) AddTriangles(builder, body, triangles);
    if (triangles.size() == before) {
      return FieldError(path, absl::StrCat("body \"", body.name, "\" is not ROLE_DEFORMABLE, or has no triangles to ",
                                           "bind to; leave mode out, or name another body"));
    }
  }
  Triangles columns(3, static_cast<Eigen::Index>(triangles.size()));
  for (size_t t = 0; t < triangles.size(); ++t) columns.col(static_cast<Eigen::Index>(t)) = triangles[t];
  return TriangleBinder(builder, columns);
}

TriangleBinder::TriangleBinder(const ModelBuilder& builder, const Triangles& triangles)
    : builder_(builder), tree_(builder.model.rest, triangles) {
  tree_.Fit(builder.model.rest, boxes_);
}

Skin TriangleBinder::Bind(int body, v1::MappingReport& report) const {
  const BodyModel& seen = builder_.model.bodies[body];
  const ConstPoints x = builder_.model.rest;
  Skin skin{.body = body, .weights = {}, .triangles = {}};
  double sum = 0, furthest = 0, highest = 0;
  for (Eigen::Index i = 0; i < seen.mesh.vertices.cols() && !builder_.stop.Stopped(); ++i) {
    const Eigen::Vector3d point = seen.mesh.vertices.col(i);
    const SurfacePoint nearest = tree_.Nearest(x, boxes_, point, std::numeric_limits<double>::infinity());
    skin.triangles.push_back(BindTo(x, tree_.triangle(nearest.triangle), point));
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
