#include "server/fit/structures.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mesh/nearest.h"
#include "server/mesh/topology.h"
#include "server/mesh/triangle_tree.h"

namespace phrenic::fit {
namespace {

constexpr double kGridSpacing = 0.007, kInside = 0.002;  // [m]
constexpr double kDownwards = -0.5;                      // z of the normals of a base
constexpr double kNoContact = 1e-3;                      // [1/m]
constexpr double kLeastOfVolume = 0.2;                   // that a part of a lung keeps when it is bent
constexpr int kBendRounds = 10;
constexpr double kSoftest = 20, kStiffening = 1.8;  // of the springs: of the first round [1/m], from one to the next
constexpr double kSettled = 1e-4;                   // [m]

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

// Returns the displacement of the surface's vertices.
Points ShiftsOf(const LungTissue& tissue, const Points& nodes) {
  Points shifts(3, tissue.surface().vertices.cols());
  for (Eigen::Index i = 0; i < shifts.cols(); ++i) {
    shifts.col(i) = tissue.DisplacementAt(nodes, tissue.surface().vertices.col(i));
  }
  return shifts;
}

// Returns the least determinant of the deformation's gradient at the bricks' nodes and the surface.
double LeastVolume(const LungTissue& tissue, const Points& nodes) {
  double least = HUGE_VAL;
  for (const Points& points : {tissue.points(), tissue.surface().vertices}) {
    for (const auto& point : points.colwise()) {
      const Eigen::Matrix3d gradient = Eigen::Matrix3d::Identity() + tissue.GradientAt(nodes, point);
      least = std::min(least, gradient.determinant());
    }
  }
  return least;
}

// Returns the vectors from the surface at rest to the person's: of each vertex to the nearest point of the person's
// surface, and to each of the person's vertices, up to as many, from the nearest vertex.
struct BendPairs {
  Points from, vectors;
};

BendPairs PairsFor(const Mesh& rest, const Mesh& moved, const Mesh& target, const TriangleTree& tree,
                   const TriangleTree::Boxes& boxes) {
  const Eigen::Index own = moved.vertices.cols(), stride = std::max<Eigen::Index>(1, target.vertices.cols() / own);
  const Eigen::Index back = (target.vertices.cols() + stride - 1) / stride;
  BendPairs pairs = {Points(3, own + back), Points(3, own + back)};
  for (Eigen::Index i = 0; i < own; ++i) {
    const SurfacePoint near = tree.Nearest(target.vertices, boxes, moved.vertices.col(i), HUGE_VAL);
    pairs.from.col(i) = rest.vertices.col(i);
    pairs.vectors.col(i) = moved.vertices.col(i) + near.offset - rest.vertices.col(i);
  }
  const NearestSearch search(moved.vertices);
  for (Eigen::Index k = 0; k < back; ++k) {
    const Eigen::Vector3d at = target.vertices.col(k * stride);
    const int vertex = search.Nearest(at).vertex;
    pairs.from.col(own + k) = rest.vertices.col(vertex);
    pairs.vectors.col(own + k) = at - rest.vertices.col(vertex);
  }
  for (auto vector : pairs.vectors.colwise()) vector *= std::min(1.0, kMostBend / std::max(vector.norm(), 1e-12));
  return pairs;
}

// Returns the displacement of the grid's nodes that bends the lung onto the person's surface.
absl::StatusOr<Points> BendOnto(const LungTissue& tissue, const Mesh& target) {
  const TriangleTree tree(target.vertices, target.triangles);
  TriangleTree::Boxes boxes;
  tree.Fit(target.vertices, boxes);
  Mesh moved = tissue.surface();
  Points nodes = Points::Zero(3, tissue.grid().nodes().cols());
  double stiffness = kSoftest, growth = kStiffening;
  for (int round = 0; round < kBendRounds; ++round) {
    const BendPairs pairs = PairsFor(tissue.surface(), moved, target, tree, boxes);
    const double weight = stiffness * tissue.areas().sum() / static_cast<double>(pairs.from.cols());
    absl::StatusOr<Points> next = tissue.SolveThrough(pairs.from, pairs.vectors, weight);
    if (!next.ok()) return next.status();
    if (LeastVolume(tissue, *next) < kLeastOfVolume) {
      if (growth == 1) break;  // the next round would solve the same
      stiffness /= growth;     // as stiff as did not fold
      growth = 1;
      continue;
    }
    const double change = (*next - nodes).colwise().norm().maxCoeff();
    nodes = *std::move(next);
    moved.vertices = tissue.surface().vertices + ShiftsOf(tissue, nodes);
    stiffness = std::min(kBendStiffness, growth * stiffness);
    if (change < kSettled) break;
  }
  return nodes;
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
  BentLungs unbent;
  for (const Side side : {kRight, kLeft})
    unbent.surfaces[side] = registered.lungs[side].Apply(templates[side].surface());
  return CompareStructures(unbent, structures);
}

absl::StatusOr<BentLungs> BendLungs(const LungTemplates& templates, const RegisteredLungs& registered,
                                    const std::vector<PersonStructure>& structures) {
  BentLungs bent;
  for (const Side side : {kRight, kLeft}) {
    const PersonStructure* target = FindStructure(structures, side == kLeft ? "lung-left" : "lung-right");
    LungElasticity soft;
    soft.contact = kNoContact;
    const auto tissue = LungTissue::Make(registered.lungs[side].Apply(templates[side].surface()), soft);
    if (!tissue.ok()) return tissue.status();
    const absl::StatusOr<Points> nodes = BendOnto(*tissue, target->surface);
    if (!nodes.ok()) return nodes.status();
    bent.surfaces[side] = tissue->surface();
    const Points shift = ShiftsOf(*tissue, *nodes);
    bent.surfaces[side].vertices += shift;
    bent.most[side] = shift.colwise().norm().maxCoeff();
    bent.volume[side] = LeastVolume(*tissue, *nodes);
  }
  return bent;
}

std::vector<StructureResidual> CompareStructures(const BentLungs& bent,
                                                 const std::vector<PersonStructure>& structures) {
  std::vector<StructureResidual> residuals;
  for (const PersonStructure& each : structures) {
    std::vector<double> distances;
    for (const Side side : {kRight, kLeft}) {
      const Mesh& lung = bent.surfaces[side];
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
