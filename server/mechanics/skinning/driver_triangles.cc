#include "server/mechanics/skinning/driver_triangles.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"

namespace phrenic {
namespace {

constexpr double kNoArea = 1e-9;  // relative to the longest edge squared: smaller triangles count as degenerate

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

}  // namespace

absl::StatusOr<Triangles> DriverTriangles(const ModelBuilder& builder, const std::vector<int>& bodies,
                                          std::string_view path) {
  std::vector<Eigen::Vector3i> triangles;
  for (const int b : bodies) {
    const BodyModel& body = builder.model.bodies[b];
    const size_t before = triangles.size();
    if (body.first_vertex >= 0) AddTriangles(builder, body, triangles);
    if (triangles.size() == before) {
      return FieldError(path, absl::StrCat("body \"", body.name, "\" is not ROLE_DEFORMABLE, or has no triangles to ",
                                           "bind to; leave mode out, or name another body"));
    }
  }
  Triangles columns(3, static_cast<Eigen::Index>(triangles.size()));
  for (size_t t = 0; t < triangles.size(); ++t) columns.col(static_cast<Eigen::Index>(t)) = triangles[t];
  return columns;
}

TriangleBinding BindToPlane(const ConstPoints& x, const Eigen::Vector3i& t, const Eigen::Vector3d& point) {
  const Eigen::Vector3d area = AreaVector(x, t);
  const Eigen::Vector3d a = x.col(t[0]), b = x.col(t[1]), c = x.col(t[2]);
  const double squared = area.squaredNorm();
  const double of_b = area.dot((point - a).cross(c - a)) / squared, of_c = area.dot((b - a).cross(point - a)) / squared;
  return {t, {1 - of_b - of_c, of_b, of_c}, area.dot(point - a) / std::sqrt(squared)};
}

}  // namespace phrenic
