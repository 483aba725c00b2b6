#include "server/imaging/surfaces/scanned_diaphragm.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "server/mesh/normals.h"
#include "server/mesh/triangle_tree.h"
#include "server/mesh/units.h"

namespace phrenic::imaging {
namespace {

constexpr double kSearch = 15, kSearchStep = 0.5;  // along the normal [mm]
constexpr double kMostARound = 8;                  // [mm]
constexpr double kHalfThickness = 4;               // of what is seen, at most [mm]
constexpr double kOuterLayer = 1.8;                // outside of the cage, at most [mm]

// Looks up the voxels of one part.
class VoxelsOf {
 public:
  VoxelsOf(const LabelVolume& volume, const Mask& mask) : mask_(mask), to_voxel_(volume.to_patient.inverse()) {}

  // True if a point [mm] is in the part.
  bool Contains(const Eigen::Vector3d& point) const {
    const Eigen::Vector3i at = (to_voxel_ * point).array().round().cast<int>() - mask_.low.array();
    if ((at.array() < 0).any() || (at.array() >= mask_.size.array()).any()) return false;
    return mask_.inside[mask_.Index(at.x(), at.y(), at.z())] == 1;
  }

 private:
  const Mask& mask_;
  const Eigen::Affine3d to_voxel_;
};

// Returns how far along the normal the middle of the part is that is nearest to the point [mm]; nullopt if the
// part is not within reach.
std::optional<double> MiddleAlong(const VoxelsOf& part, const Eigen::Vector3d& point, const Eigen::Vector3d& normal) {
  std::optional<double> nearest;
  double entered = std::numeric_limits<double>::quiet_NaN();
  for (double s = -kSearch; s <= kSearch; s += kSearchStep) {
    const bool inside = part.Contains(point + s * normal);
    if (inside && std::isnan(entered)) entered = s;
    if (inside || std::isnan(entered)) continue;
    const double middle = (entered + s - kSearchStep) / 2;
    if (!nearest.has_value() || std::abs(middle) < std::abs(*nearest)) nearest = middle;
    entered = std::numeric_limits<double>::quiet_NaN();
  }
  return nearest;
}

// Averages the values over each vertex and its neighbours, some times. Vertices of weight 0 take those of neighbours.
Eigen::VectorXd Averaged(const Triangles& triangles, Eigen::VectorXd values, Eigen::VectorXd weights, int passes) {
  for (int pass = 0; pass < passes; ++pass) {
    Eigen::VectorXd sum = values.cwiseProduct(weights), weight = weights;
    for (const auto t : triangles.colwise()) {
      for (int c = 0; c < 3; ++c) {
        const int next = t[(c + 1) % 3], last = t[(c + 2) % 3];
        sum[t[c]] += (values[next] * weights[next] + values[last] * weights[last]) / 4;
        weight[t[c]] += (weights[next] + weights[last]) / 4;
      }
    }
    values = sum.cwiseQuotient(weight.cwiseMax(1e-12));
    weights = weight.cwiseMin(1);
  }
  return values;
}

// Returns how far each vertex [m] is to move along its normal [mm].
Eigen::VectorXd TowardsMiddle(const VoxelsOf& part, const Mesh& mesh, const Points& normals) {
  Eigen::VectorXd moves = Eigen::VectorXd::Zero(mesh.vertices.cols()), weights = moves;
  for (Eigen::Index i = 0; i < mesh.vertices.cols(); ++i) {
    const std::optional<double> middle = MiddleAlong(part, mesh.vertices.col(i) / kMillimetre, normals.col(i));
    if (!middle.has_value()) continue;
    moves[i] = std::clamp(*middle, -kMostARound, kMostARound);
    weights[i] = 1;
  }
  for (const int i : mesh.regions.at("insertion")) weights[i] = 0;  // narrow there: neighbours know better
  constexpr int kPasses = 12;
  return Averaged(mesh.triangles, std::move(moves), std::move(weights), kPasses);
}

// Moves each vertex that is not on the border halfway to the mean of its neighbours.
void Relax(Mesh& mesh) {
  Points sum = Points::Zero(3, mesh.vertices.cols());
  Eigen::VectorXd count = Eigen::VectorXd::Zero(mesh.vertices.cols());
  for (const auto t : mesh.triangles.colwise()) {
    for (int c = 0; c < 3; ++c) {
      sum.col(t[c]) += mesh.vertices.col(t[(c + 1) % 3]) + mesh.vertices.col(t[(c + 2) % 3]);
      count[t[c]] += 2;
    }
  }
  for (const int i : mesh.regions.at("rim")) count[i] = 0;
  for (Eigen::Index i = 0; i < mesh.vertices.cols(); ++i) {
    if (count[i] > 0) mesh.vertices.col(i) = (mesh.vertices.col(i) + sum.col(i) / count[i]) / 2;
  }
}

// Draws vertices that are beyond the border of the middle surface near to it, in their order: what follows a triangle
// from outside of it moves more than the triangle.
void DrawToBorder(const Mesh& middle, Mesh& layers) {
  constexpr double kBeyond = 1.5;  // at most [mm]
  const Points normals = VertexNormals(middle.vertices, middle.triangles);
  const TriangleTree tree(middle.vertices, middle.triangles);
  TriangleTree::Boxes boxes;
  tree.Fit(middle.vertices, boxes);
  for (auto x : layers.vertices.colwise()) {
    const SurfacePoint nearest = tree.Nearest(middle.vertices, boxes, x, std::numeric_limits<double>::infinity());
    if (!nearest.on_boundary) continue;
    const Eigen::Vector3d n = (normals(Eigen::all, tree.triangle(nearest.triangle)) * nearest.weights).normalized();
    const Eigen::Vector3d from = -nearest.offset, aside = from - from.dot(n) * n;
    const double beyond = aside.norm() / kMillimetre;
    if (beyond > 1e-6) x -= (1 - kBeyond * (1 - std::exp(-beyond / kBeyond)) / beyond) * aside;
  }
}

// Adds the whole rim to what is fixed to bone.
void FixRim(Mesh& mesh) {
  const std::vector<int>& rim = mesh.regions.at("rim");
  std::vector<int>& fixed = mesh.regions["insertion"];
  fixed.insert(fixed.end(), rim.begin(), rim.end());
  std::ranges::sort(fixed);
  fixed.erase(std::unique(fixed.begin(), fixed.end()), fixed.end());
}

// Draws the mesh to the wall, each vertex towards its nearest point on it: onto it from outside and from 1 mm inside,
// by ever less up to 5 mm. Beside the spine the wall's radii meet it at small angles, and would fold the mesh.
void DrawToWall(const Mesh& wall, Mesh& mesh) {
  const TriangleTree tree(wall.vertices, wall.triangles);
  TriangleTree::Boxes boxes;
  tree.Fit(wall.vertices, boxes);
  for (auto x : mesh.vertices.colwise()) {
    const SurfacePoint nearest = tree.Nearest(wall.vertices, boxes, x, std::numeric_limits<double>::infinity());
    const double distance = std::sqrt(nearest.squared) / kMillimetre;
    if (nearest.on_boundary || distance == 0) continue;
    const double gap = nearest.facing > 0 ? -distance : distance;
    x += (gap - FittedCage::DrawnGap(gap)) / gap * nearest.offset;
  }
}

}  // namespace

Mesh FollowScan(const LabelVolume& volume, const Mask& scanned, const Mesh& wall, Mesh& middle) {
  constexpr int kRounds = 8;
  FixRim(middle);
  const VoxelsOf part(volume, scanned);
  for (int round = 0; round < kRounds; ++round) {
    if (round > 0) Relax(middle);
    const Points normals = VertexNormals(middle.vertices, middle.triangles);
    const Eigen::VectorXd moves = TowardsMiddle(part, middle, normals);
    middle.vertices += kMillimetre * normals * moves.asDiagonal();
  }
  Mesh before = middle;
  DrawToWall(wall, middle);
  return before;
}

void DrawLayers(const Mesh& before, const Mesh& after, const FittedCage& cage, Mesh& scanned) {
  constexpr int kPasses = 4;
  const TriangleTree tree(before.vertices, before.triangles);
  TriangleTree::Boxes boxes;
  tree.Fit(before.vertices, boxes);
  Points moves(3, scanned.vertices.cols());
  for (Eigen::Index i = 0; i < moves.cols(); ++i) {
    const Eigen::Vector3d x = scanned.vertices.col(i);
    const SurfacePoint nearest = tree.Nearest(before.vertices, boxes, x, std::numeric_limits<double>::infinity());
    const Eigen::Vector3i corners = tree.triangle(nearest.triangle);
    const Eigen::Vector3d from = -nearest.offset, foot = after.vertices(Eigen::all, corners) * nearest.weights;
    const double kept = std::min(1.0, kMillimetre * kHalfThickness / std::max(from.norm(), 1e-9));
    moves.col(i) = kMillimetre * cage.Within((foot + kept * from) / kMillimetre, kOuterLayer) - x;
  }
  const Eigen::VectorXd all = Eigen::VectorXd::Ones(moves.cols());
  for (int axis = 0; axis < 3; ++axis) {
    scanned.vertices.row(axis) += Averaged(scanned.triangles, moves.row(axis).transpose(), all, kPasses).transpose();
  }
  DrawToBorder(after, scanned);
}

}  // namespace phrenic::imaging
