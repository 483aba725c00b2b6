#include "server/mechanics/skinning/sheet_skin.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mechanics/parallel/compile_threads.h"
#include "server/mechanics/skinning/driver_triangles.h"
#include "server/mesh/normals.h"
#include "server/mesh/units.h"

namespace phrenic {
namespace {

constexpr double kOutside = -1e-9;  // a foot point with a weight below is outside its triangle

// True if `a` is the better foot point: further inside its triangle, or nearer if both are inside.
bool Better(const TriangleBinding& a, const TriangleBinding& b) {
  const double in_a = std::min(a.weights.minCoeff(), kOutside), in_b = std::min(b.weights.minCoeff(), kOutside);
  return in_a != in_b ? in_a > in_b : std::abs(a.height) < std::abs(b.height);
}

// Returns beta, gamma and h of `offset` = beta u + gamma v + h n. Requires: they are independent.
Eigen::Vector3d InBasis(const Eigen::Vector3d& u, const Eigen::Vector3d& v, const Eigen::Vector3d& n,
                        const Eigen::Vector3d& offset) {
  const Eigen::Vector3d v_n = v.cross(n), n_u = n.cross(u), u_v = u.cross(v);
  return Eigen::Vector3d(v_n.dot(offset), n_u.dot(offset), u_v.dot(offset)) / u_v.dot(n);
}

// Checks that a vertex has a foot point within the thickness [m]. `skin` is the path of the scene's message.
absl::Status CheckFoot(const TriangleBinding& foot, double thickness, const std::string& vertex,
                       const std::string& skin) {
  if (foot.corners[0] < 0) {
    return FieldError(skin + ".drivers",
                      vertex +
                          " has no foot point on them, which are bent too sharply there; smooth or refine them, "
                          "or use SKIN_MODE_TRIANGLES");
  }
  const double distance = std::abs(foot.height);
  if (distance <= thickness) return absl::OkStatus();
  return FieldError(skin + ".thickness",
                    absl::StrFormat("%s is %.3g mm from the drivers, further than %g mm; refine the drivers, or set a "
                                    "larger thickness",
                                    vertex, kMillimetresAMetre * distance, kMillimetresAMetre * thickness));
}

}  // namespace

absl::StatusOr<SheetBinder> SheetBinder::Make(const ModelBuilder& builder, const std::vector<int>& drivers,
                                              std::string_view path) {
  const absl::StatusOr<Triangles> triangles = DriverTriangles(builder, drivers, path);
  if (!triangles.ok()) return triangles.status();
  return SheetBinder(builder, *triangles);
}

SheetBinder::SheetBinder(const ModelBuilder& builder, const Triangles& triangles)
    : builder_(builder), sheet_(std::make_shared<DriverSheet>()), tree_(builder.model.rest, triangles) {
  tree_.Fit(builder.model.rest, boxes_);
  const int first = triangles.minCoeff(), count = triangles.maxCoeff() + 1 - first;
  const Triangles local = triangles.array() - first;
  const ConstPoints x = builder.model.rest.middleCols(first, count);
  normals_ = VertexNormals(x, local);
  *sheet_ = {.first_vertex = first, .triangles = triangles, .rest_areas = 3 * VertexAreas(x, local)};
  fans_.resize(static_cast<size_t>(count));
  for (int t = 0; t < static_cast<int>(triangles.cols()); ++t) {
    for (const int vertex : tree_.triangle(t)) fans_[vertex - first].push_back(t);
  }
}

bool SheetBinder::FindFoot(const Eigen::Vector3i& triangle, const Eigen::Vector3d& point, double fraction,
                           TriangleBinding& foot) const {
  const int rounds = static_cast<int>(60 / fraction);
  constexpr double kSettled = 1e-13;
  const Points& x = builder_.model.rest;
  const Eigen::Vector3d a = x.col(triangle[0]), u = x.col(triangle[1]) - a, v = x.col(triangle[2]) - a;
  const Eigen::Matrix3d normals = normals_(Eigen::all, triangle.array() - sheet_->first_vertex);
  foot = BindToPlane(x, triangle, point);
  for (int round = 0; round < rounds; ++round) {
    const Eigen::Vector3d in_basis = InBasis(u, v, (normals * foot.weights).normalized(), point - a);
    const Eigen::Vector3d weights(1 - in_basis[0] - in_basis[1], in_basis[0], in_basis[1]);
    const double change = (weights - foot.weights).cwiseAbs().maxCoeff();
    foot.weights = fraction == 1 ? weights : Eigen::Vector3d(foot.weights + fraction * (weights - foot.weights));
    foot.height = in_basis[2];
    if (change < kSettled) return true;
    if (!std::isfinite(change)) return false;
  }
  return false;
}

TriangleBinding SheetBinder::Foot(const Eigen::Vector3d& point) const {
  const SurfacePoint nearest =
      tree_.Nearest(builder_.model.rest, boxes_, point, std::numeric_limits<double>::infinity());
  const Eigen::Vector3i triangle = tree_.triangle(nearest.triangle);
  TriangleBinding best, foot;
  bool found = FindFoot(triangle, point, 1, best);
  if (found && best.weights.minCoeff() >= kOutside) return best;
  // Where the surface is bent too sharply for the iteration, it may still converge by a part of each step.
  for (const double fraction : {1.0, 0.25}) {
    for (const int vertex : triangle) {
      for (const int t : fans_[vertex - sheet_->first_vertex]) {
        if (!FindFoot(tree_.triangle(t), point, fraction, foot) || (found && !Better(foot, best))) continue;
        best = foot;
        found = true;
      }
    }
    if (found) return best;
  }
  best.corners.setConstant(-1);
  return best;
}

absl::StatusOr<Skin> SheetBinder::Bind(int body, double thickness, const std::string& path,
                                       v1::MappingReport& report) const {
  const BodyModel& seen = builder_.model.bodies[body];
  const auto n = static_cast<int>(seen.mesh.vertices.cols());
  Skin skin{.body = body, .weights = {}, .triangles = std::vector<TriangleBinding>(n), .sheet = sheet_};
  ForEachPart(CountParts(n), [&](std::int64_t part) {
    const PartRange range = PartOf(n, part);
    for (std::int64_t i = range.first; i < range.end; ++i) skin.triangles[i] = Foot(seen.mesh.vertices.col(i));
  });
  double sum = 0, furthest = 0;
  for (int i = 0; i < n; ++i) {
    const TriangleBinding& foot = skin.triangles[i];
    const std::string vertex = absl::StrCat("vertex ", i, " of body \"", seen.name, "\"");
    if (absl::Status status = CheckFoot(foot, thickness, vertex, path); !status.ok()) return status;
    sum += std::abs(foot.height);
    furthest = std::max(furthest, std::abs(foot.height));
  }
  report.set_body(seen.name);
  report.set_mean_distance_mm(kMillimetresAMetre * sum / n);
  report.set_largest_distance_mm(kMillimetresAMetre * furthest);
  return skin;
}

}  // namespace phrenic
