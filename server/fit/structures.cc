#include "server/fit/structures.h"

#include <cmath>
#include <limits>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mesh/topology.h"
#include "server/mesh/triangle_tree.h"

namespace phrenic::fit {
namespace {

constexpr double kGridSpacing = 0.007, kInside = 0.002;  // [m]
constexpr double kDownwards = -0.5;                      // z of the normals of a base

const PersonStructure* FindStructure(const std::vector<PersonStructure>& structures, const std::string& name) {
  for (const PersonStructure& each : structures) {
    if (each.name == name) return &each;
  }
  return nullptr;
}

double VolumeOf(const Mesh& mesh) {
  double sum = 0;
  for (const auto& triangle : mesh.triangles.colwise()) {
    const Eigen::Vector3d a = mesh.vertices.col(triangle[0]), b = mesh.vertices.col(triangle[1]),
                          c = mesh.vertices.col(triangle[2]);
    sum += a.dot(b.cross(c)) / 6;
  }
  return sum;
}

absl::Status CheckLung(const PersonStructure& lung) {
  if (!AnalyseTopology(lung.surface).watertight()) {
    return absl::InvalidArgumentError(
        absl::StrCat(lung.source, ": the surface of ", lung.name,
                     " is not closed: see phrenic inspect, and phrenic convert --repair"));
  }
  if (VolumeOf(lung.surface) > 0) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat(lung.source, ": the surface of ", lung.name,
                                                 " faces inwards: turn it by phrenic convert --repair orient"));
}

void AppendInside(const Mesh& surface, std::vector<Eigen::Vector3d>& points) {
  const LungTemplate lung(surface);
  const Eigen::Vector3i count = (lung.box().sizes() / kGridSpacing).array().ceil().cast<int>();
  for (int k = 0; k <= count.z(); ++k) {
    for (int j = 0; j <= count.y(); ++j) {
      for (int i = 0; i <= count.x(); ++i) {
        const Eigen::Vector3d at = lung.box().min() + kGridSpacing * Eigen::Vector3d(i, j, k);
        if (lung.DistanceAt(at) <= -kInside) points.push_back(at);
      }
    }
  }
}

// Appends the distances of the points from a surface.
void AppendDistances(const Points& points, const Mesh& surface, std::vector<double>& distances) {
  const TriangleTree tree(surface.vertices, surface.triangles);
  TriangleTree::Boxes boxes;
  tree.Fit(surface.vertices, boxes);
  for (const auto& point : points.colwise()) {
    const double squared =
        tree.Nearest(surface.vertices, boxes, point, std::numeric_limits<double>::infinity()).squared;
    distances.push_back(std::sqrt(squared));
  }
}

// Returns the middles of the triangles that face down.
Points MiddlesOfBase(const Mesh& lung) {
  std::vector<Eigen::Vector3d> middles;
  for (const auto& triangle : lung.triangles.colwise()) {
    const Eigen::Vector3d a = lung.vertices.col(triangle[0]), b = lung.vertices.col(triangle[1]),
                          c = lung.vertices.col(triangle[2]);
    if ((b - a).cross(c - a).normalized().z() < kDownwards) middles.emplace_back((a + b + c) / 3);
  }
  Points points(3, static_cast<Eigen::Index>(middles.size()));
  for (size_t i = 0; i < middles.size(); ++i) points.col(static_cast<Eigen::Index>(i)) = middles[i];
  return points;
}

StructureResidual ResidualOf(const std::string& name, bool shaped, const std::vector<double>& distances) {
  double sum = 0;
  for (const double each : distances) sum += each;
  return {name, shaped, sum / static_cast<double>(distances.size()), Quantile(distances, 0.95),
          static_cast<int>(distances.size())};
}

}  // namespace

absl::StatusOr<Points> PointsInLungs(const std::vector<PersonStructure>& structures) {
  const PersonStructure *right = FindStructure(structures, "lung-right"),
                        *left = FindStructure(structures, "lung-left");
  if (right == nullptr || left == nullptr) {
    return absl::InvalidArgumentError(
        absl::StrCat("the ", right == nullptr ? "right" : "left", " lung is missing: both lungs are needed"));
  }
  for (const PersonStructure* lung : {right, left}) {
    if (absl::Status status = CheckLung(*lung); !status.ok()) return status;
  }
  const double right_x = right->surface.vertices.row(0).mean(), left_x = left->surface.vertices.row(0).mean();
  if (right_x >= left_x) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "%s: the right lung lies at x = %.0f mm, the left one at %.0f: in LPS the left has the larger x; exchange the "
        "files, or declare their frame (SPACE=RAS)",
        right->source, 1000 * right_x, 1000 * left_x));
  }
  std::vector<Eigen::Vector3d> inside;
  AppendInside(right->surface, inside);
  AppendInside(left->surface, inside);
  Points points(3, static_cast<Eigen::Index>(inside.size()));
  for (size_t i = 0; i < inside.size(); ++i) points.col(static_cast<Eigen::Index>(i)) = inside[i];
  return points;
}

std::vector<StructureResidual> CompareStructures(const LungTemplates& templates, const RegisteredLungs& registered,
                                                 const std::vector<PersonStructure>& structures) {
  std::vector<StructureResidual> residuals;
  for (const PersonStructure& each : structures) {
    std::vector<double> distances;
    for (const Side side : {kRight, kLeft}) {
      const Mesh lung = registered.lungs[side].Apply(templates[side].surface());
      if (each.name == (side == kLeft ? "lung-left" : "lung-right")) {
        AppendDistances(each.surface.vertices, lung, distances);
        AppendDistances(lung.vertices, each.surface, distances);
      } else if (each.name == "diaphragm") {
        AppendDistances(MiddlesOfBase(lung), each.surface, distances);
      }
    }
    if (!distances.empty()) residuals.push_back(ResidualOf(each.name, each.name != "diaphragm", distances));
  }
  return residuals;
}

}  // namespace phrenic::fit
