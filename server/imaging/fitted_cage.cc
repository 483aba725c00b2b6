#include "server/imaging/fitted_cage.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "absl/strings/str_format.h"

namespace phrenic::imaging {
namespace {

constexpr int kColumns = 144;
constexpr double kRowHeight = 4;                    // [mm]
constexpr double kOffCage = 3.5;                    // of the wall from a bone's inner face [mm]
constexpr double kFurthestBone = 260;               // of rays from the axis [mm]
constexpr double kShortestStep = 0.1;               // along a ray, however fine the voxels are [mm]
constexpr double kNarrowest = 8;                    // [mm]
constexpr double kStiffness = 1, kUpright = 0.02;   // bending and tension, relative to a weight of 1 a ray
constexpr double kNearer = 10;                      // weight of a bone that is nearer to the axis than the wall
constexpr double kFurtherOut = 0.3;                 // weight of a bone that is further out than the wall
constexpr double kOntoWall = 1, kFreeFromWall = 5;  // distances from the wall [mm]
constexpr double kFullTurn = 2 * std::numbers::pi;

bool IsBone(const Part& part) {
  return part.Is(v1::STRUCTURE_RIB) || part.Is(v1::STRUCTURE_COSTAL_CARTILAGE) || part.Is(v1::STRUCTURE_VERTEBRA) ||
         part.Is(v1::STRUCTURE_STERNUM_BODY) || part.Is(v1::STRUCTURE_MANUBRIUM) || part.Is(v1::STRUCTURE_XIPHOID);
}

// Returns 1 for each voxel of bone.
std::vector<std::uint8_t> FindBone(const LabelVolume& volume, const std::vector<Part>& parts) {
  std::vector<std::uint8_t> bone(volume.labels.size(), 0);
  for (const Part& part : parts) {
    if (!IsBone(part)) continue;
    const Mask& mask = part.mask;
    for (std::size_t at = 0; at < mask.inside.size(); ++at) {
      const auto row = static_cast<int>(at / mask.size.x());
      const Eigen::Vector3i voxel =
          mask.low + Eigen::Vector3i(static_cast<int>(at % mask.size.x()), row % mask.size.y(), row / mask.size.y());
      if (mask.inside[at] == 1 && volume.Contains(voxel)) bone[volume.Index(voxel)] = 1;
    }
  }
  return bone;
}

// Returns the distance of the first voxel of bone on each ray of the grid; infinity if a ray meets no bone.
Eigen::VectorXd DistancesOfBone(const LabelVolume& volume, const std::vector<Part>& parts, const CageFrame& frame,
                                const PlateGrid& grid, double bottom) {
  const std::vector<std::uint8_t> bone = FindBone(volume, parts);
  const Eigen::Affine3d to_voxel = volume.to_patient.inverse();
  const double step = std::max(volume.Spacing().minCoeff() / 3, kShortestStep);
  Eigen::VectorXd distances = Eigen::VectorXd::Constant(grid.nodes(), HUGE_VAL);
  for (int node = 0; node < grid.nodes(); ++node) {
    const int row = node / grid.columns;
    const double z = bottom + kRowHeight * row, azimuth = kFullTurn * (node % grid.columns) / kColumns;
    const Eigen::Vector2d axis = frame.Axis(z);
    const Ray ray{{axis.x(), axis.y(), z}, {std::sin(azimuth), -std::cos(azimuth), 0}};
    for (double depth = step; depth < kFurthestBone; depth += step) {
      const Eigen::Vector3i voxel = (to_voxel * ray.At(depth)).array().round().cast<int>();
      if (!volume.Contains(voxel) || bone[volume.Index(voxel)] == 0) continue;
      distances[node] = depth;
      break;
    }
  }
  return distances;
}

// Fits R to the distances of bones, from inside.
Eigen::VectorXd FitRadius(const PlateGrid& grid, const Eigen::VectorXd& bones) {
  constexpr int kRounds = 10;
  ThinPlate plate(grid, kStiffness, kUpright);
  Eigen::VectorXd weights(grid.nodes()), observed(grid.nodes()), radius;
  for (int i = 0; i < grid.nodes(); ++i) {
    weights[i] = std::isfinite(bones[i]) ? 1 : 0;
    observed[i] = std::isfinite(bones[i]) ? bones[i] - kOffCage : 0;
  }
  for (int round = 0; round < kRounds; ++round) {
    radius = plate.Fit(weights, observed);
    for (int i = 0; i < grid.nodes(); ++i) {
      if (std::isfinite(bones[i])) weights[i] = radius[i] > observed[i] ? kNearer : kFurtherOut;
    }
  }
  return radius.cwiseMax(kNarrowest);
}

void ReportFit(const Eigen::VectorXd& bones, const Eigen::VectorXd& radius, Messages& fallbacks) {
  std::vector<double> distances;
  for (Eigen::Index i = 0; i < bones.size(); ++i) {
    if (std::isfinite(bones[i])) distances.push_back(bones[i] - radius[i]);
  }
  if (distances.empty()) return;
  std::sort(distances.begin(), distances.end());
  fallbacks.push_back(absl::StrFormat(
      "chest wall: no bone in %.0f %% of the directions, bridged; bones are %.1f mm from it at least, %.1f in 95 %%",
      100 - 100.0 * static_cast<double>(distances.size()) / static_cast<double>(bones.size()), distances.front(),
      distances[distances.size() / 20]));
}

// Returns the gap of a point after it was drawn onto the wall; monotone and smooth.
double DrawnGap(double gap) {
  if (gap > -kOntoWall) return 0;
  if (gap < -kFreeFromWall) return gap;
  const double t = (-gap - kOntoWall) / (kFreeFromWall - kOntoWall);
  return gap * t * t * (3 - 2 * t);
}

}  // namespace

FittedCage::FittedCage(const LabelVolume& volume, const std::vector<Part>& parts, const CageFrame& frame,
                       Messages& fallbacks)
    : frame_(frame), bottom_(frame.lumbar[2] - frame.vertebra_height / 2) {
  grid_ = {kColumns, 1 + std::max(8, static_cast<int>(std::ceil((frame.top - bottom_) / kRowHeight))), true};
  const Eigen::VectorXd bones = DistancesOfBone(volume, parts, frame, grid_, bottom_);
  radius_ = FitRadius(grid_, bones);
  ReportFit(bones, radius_, fallbacks);
}

double FittedCage::Radius(double azimuth, double z) const {
  const double column = (azimuth / kFullTurn - std::floor(azimuth / kFullTurn)) * kColumns;
  const double row = std::clamp((z - bottom_) / kRowHeight, 0.0, grid_.rows - 1.0);
  const int i = static_cast<int>(std::floor(column)), j = static_cast<int>(row);
  const auto across = SplineWeights(column - i), along = SplineWeights(row - j);
  double radius = 0;
  for (int b = 0; b < 4; ++b) {
    for (int a = 0; a < 4; ++a) {
      const int nearest = std::clamp(j + b - 1, 0, grid_.rows - 1);
      radius += across[a] * along[b] * radius_[grid_.Index((i + a - 1 + kColumns) % kColumns, nearest)];
    }
  }
  return radius;
}

FittedCage::Polar FittedCage::PolarOf(const Eigen::Vector3d& point) const {
  const Eigen::Vector2d axis = frame_.Axis(point.z()), from = point.head<2>() - axis;
  const double azimuth = std::atan2(from.x(), -from.y());
  return {axis, azimuth, from.norm()};
}

Eigen::Vector3d FittedCage::Inside(const Eigen::Vector3d& point) const {
  const Polar polar = PolarOf(point);
  if (polar.radius < kNarrowest) return point;
  const double wall = Radius(polar.azimuth, point.z());
  const double radius = wall + DrawnGap(polar.radius - wall);
  const Eigen::Vector2d moved = polar.axis + radius / polar.radius * (point.head<2>() - polar.axis);
  return {moved.x(), moved.y(), point.z()};
}

Eigen::Vector2d FittedCage::DiscCoordinates(const Eigen::Vector3d& point) const {
  const Eigen::Vector2d axis = frame_.Axis(point.z());
  Eigen::AlignedBox2d box;
  for (int i = 0; i < kColumns; ++i) {
    const double azimuth = kFullTurn * i / kColumns;
    box.extend(axis + Radius(azimuth, point.z()) * Eigen::Vector2d(std::sin(azimuth), -std::cos(azimuth)));
  }
  return 2 * (point.head<2>() - box.center()).cwiseQuotient(box.sizes());
}

bool FittedCage::OnWall(const Eigen::Vector3d& point) const {
  constexpr double kTouches = 1;  // [mm]
  const Polar polar = PolarOf(point);
  return polar.radius > Radius(polar.azimuth, point.z()) - kTouches;
}

Mesh FittedCage::Tube() const {
  Mesh mesh;
  mesh.vertices.resize(3, grid_.nodes());
  mesh.triangles.resize(3, 2 * Eigen::Index{grid_.columns} * (grid_.rows - 1));
  Eigen::Index t = 0;
  for (int node = 0; node < grid_.nodes(); ++node) {
    const int i = node % kColumns, j = node / kColumns, next = (i + 1) % kColumns;
    const double azimuth = kFullTurn * i / kColumns, z = bottom_ + kRowHeight * j;
    const Eigen::Vector2d at =
        frame_.Axis(z) + Radius(azimuth, z) * Eigen::Vector2d(std::sin(azimuth), -std::cos(azimuth));
    mesh.vertices.col(node) << at.x(), at.y(), z;
    if (j + 1 == grid_.rows) continue;
    const int right = grid_.Index(next, j), above = grid_.Index(i, j + 1), across = grid_.Index(next, j + 1);
    mesh.triangles.col(t++) << node, right, (i < kColumns / 2 ? across : above);
    mesh.triangles.col(t++) << (i < kColumns / 2 ? node : right), across, above;
  }
  for (const auto& [name, row] : {std::pair("bottom", 0), std::pair("top", grid_.rows - 1)}) {
    mesh.regions[name].resize(kColumns);
    std::iota(mesh.regions[name].begin(), mesh.regions[name].end(), grid_.Index(0, row));
  }
  return mesh;
}

}  // namespace phrenic::imaging
