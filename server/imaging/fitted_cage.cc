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
constexpr double kTouching = 3;                     // weight of a diaphragm on the wall that is further out than it
constexpr double kApposed = 15;                     // furthest diaphragm from the bones' wall that lies on it [mm]
constexpr double kOntoWall = 1, kFreeFromWall = 5;  // distances from the wall [mm]
constexpr double kFullTurn = 2 * std::numbers::pi;

bool IsBone(const Part& part) {
  return part.Is(v1::STRUCTURE_RIB) || part.Is(v1::STRUCTURE_COSTAL_CARTILAGE) || part.Is(v1::STRUCTURE_VERTEBRA) ||
         part.Is(v1::STRUCTURE_STERNUM_BODY) || part.Is(v1::STRUCTURE_MANUBRIUM) || part.Is(v1::STRUCTURE_XIPHOID);
}

enum class Found : std::uint8_t { kNeither, kBone, kSheet, kLung };

Found FoundOf(const Part& part) {
  if (IsBone(part)) return Found::kBone;
  if (part.Is(v1::STRUCTURE_DIAPHRAGM)) return Found::kSheet;
  return part.Is(v1::STRUCTURE_LUNG) ? Found::kLung : Found::kNeither;
}

// Returns what is found in each voxel. Of parts that overlap, bone and then the diaphragm win.
std::vector<Found> FindInVoxels(const LabelVolume& volume, const std::vector<Part>& parts) {
  std::vector<Found> found(volume.labels.size(), Found::kNeither);
  for (const Found kind : {Found::kLung, Found::kSheet, Found::kBone}) {
    for (const Part& part : parts) {
      if (FoundOf(part) != kind) continue;
      const Mask& mask = part.mask;
      for (std::size_t at = 0; at < mask.inside.size(); ++at) {
        const auto row = static_cast<int>(at / mask.size.x());
        const Eigen::Vector3i voxel =
            mask.low + Eigen::Vector3i(static_cast<int>(at % mask.size.x()), row % mask.size.y(), row / mask.size.y());
        if (mask.inside[at] == 1 && volume.Contains(voxel)) found[volume.Index(voxel)] = kind;
      }
    }
  }
  return found;
}

// Distances on a ray from the axis [mm]; infinity for what it does not meet.
struct Met {
  double bone = HUGE_VAL;               // of the first voxel
  double sheet = HUGE_VAL;              // of the middle of the labelled diaphragm, before any bone
  double lung_beyond_sheet = HUGE_VAL;  // of the first voxel of lung outside of that
};

// Follows a ray outwards to the first bone.
Met Follow(const LabelVolume& volume, const std::vector<Found>& found, const Eigen::Affine3d& to_voxel,
           const Ray& ray) {
  const double step = std::max(volume.Spacing().minCoeff() / 3, kShortestStep);
  Met met;
  double entered = -1;
  for (double depth = step; depth < kFurthestBone; depth += step) {
    const Eigen::Vector3i voxel = (to_voxel * ray.At(depth)).array().round().cast<int>();
    const Found here = volume.Contains(voxel) ? found[volume.Index(voxel)] : Found::kNeither;
    if (here == Found::kSheet && entered < 0) entered = depth;
    if (here != Found::kSheet && entered >= 0 && std::isinf(met.sheet)) met.sheet = (entered + depth - step) / 2;
    if (here == Found::kLung && std::isfinite(met.sheet))
      met.lung_beyond_sheet = std::min(met.lung_beyond_sheet, depth);
    if (here == Found::kBone) {
      met.bone = depth;
      break;
    }
  }
  return met;
}

// Returns what each ray of the grid meets.
std::vector<Met> FollowRays(const LabelVolume& volume, const std::vector<Part>& parts, const CageFrame& frame,
                            const PlateGrid& grid, double bottom) {
  const std::vector<Found> found = FindInVoxels(volume, parts);
  const Eigen::Affine3d to_voxel = volume.to_patient.inverse();
  std::vector<Met> rays;
  for (int node = 0; node < grid.nodes(); ++node) {
    const int row = node / grid.columns;
    const double z = bottom + kRowHeight * row, azimuth = kFullTurn * (node % grid.columns) / kColumns;
    const Eigen::Vector2d axis = frame.Axis(z);
    rays.push_back(
        Follow(volume, found, to_voxel, {{axis.x(), axis.y(), z}, {std::sin(azimuth), -std::cos(azimuth), 0}}));
  }
  return rays;
}

// What the wall is fitted to: a distance for each node, infinity if none; `touches` if the wall is there, not outside.
struct WallEvidence {
  Eigen::VectorXd distance;
  std::vector<bool> touches;
};

WallEvidence BonesOf(const std::vector<Met>& rays) {
  WallEvidence evidence{Eigen::VectorXd(static_cast<Eigen::Index>(rays.size())), std::vector<bool>(rays.size(), false)};
  for (std::size_t i = 0; i < rays.size(); ++i)
    evidence.distance[static_cast<Eigen::Index>(i)] = rays[i].bone - kOffCage;
  return evidence;
}

// Fits R to the evidence, from inside.
Eigen::VectorXd FitRadius(const PlateGrid& grid, const WallEvidence& evidence) {
  constexpr int kRounds = 10;
  ThinPlate plate(grid, kStiffness, kUpright);
  Eigen::VectorXd weights(grid.nodes()), observed(grid.nodes()), radius;
  for (int i = 0; i < grid.nodes(); ++i) {
    weights[i] = std::isfinite(evidence.distance[i]) ? 1 : 0;
    observed[i] = std::isfinite(evidence.distance[i]) ? evidence.distance[i] : 0;
  }
  for (int round = 0; round < kRounds; ++round) {
    radius = plate.Fit(weights, observed);
    const Eigen::VectorXd before = weights;
    for (int i = 0; i < grid.nodes(); ++i) {
      if (weights[i] == 0) continue;
      const double inside = evidence.touches[i] ? kTouching : kFurtherOut;
      weights[i] = radius[i] > observed[i] ? kNearer : inside;
    }
    if (weights == before) break;  // the next round would give the same bits
  }
  return radius.cwiseMax(kNarrowest);
}

// Adds the diaphragm where it lies on the wall: near its first fit, with no lung between, and not outside of it, where
// ribs may pierce it. Returns the number of nodes.
int AddApposed(const std::vector<Met>& rays, const Eigen::VectorXd& radius, WallEvidence& evidence) {
  int apposed = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto node = static_cast<Eigen::Index>(i);
    const bool near_wall = rays[i].sheet > radius[node] - kApposed && rays[i].sheet < evidence.distance[node];
    if (!std::isfinite(rays[i].sheet) || !near_wall || rays[i].lung_beyond_sheet < radius[node]) continue;
    evidence.distance[node] = std::min(rays[i].sheet, radius[node]);
    evidence.touches[i] = true;
    ++apposed;
  }
  return apposed;
}

void ReportFit(const std::vector<Met>& rays, const Eigen::VectorXd& radius, Fallbacks& fallbacks) {
  std::vector<double> distances;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (std::isfinite(rays[i].bone)) distances.push_back(rays[i].bone - radius[static_cast<Eigen::Index>(i)]);
  }
  if (distances.empty()) return;
  std::sort(distances.begin(), distances.end());
  const double bridged = 100 - 100.0 * static_cast<double>(distances.size()) / static_cast<double>(rays.size());
  const double least = distances.front(), usual = distances[distances.size() / 20];
  fallbacks.push_back({absl::StrFormat("chest wall: no bone in %.0f %% of the directions, bridged; bones are %.1f mm "
                                       "from it at least, %.1f in 95 %%",
                                       bridged, least, usual),
                       v1::ASSUMPTION_KIND_WALL,
                       {},
                       {bridged, least, usual}});
}

}  // namespace

FittedCage::FittedCage(const LabelVolume& volume, const std::vector<Part>& parts, const CageFrame& frame,
                       Fallbacks& fallbacks)
    : frame_(frame), bottom_(frame.lumbar[2] - frame.vertebra_height / 2) {
  grid_ = {kColumns, 1 + std::max(8, static_cast<int>(std::ceil((frame.top - bottom_) / kRowHeight))), true};
  const std::vector<Met> rays = FollowRays(volume, parts, frame, grid_, bottom_);
  WallEvidence evidence = BonesOf(rays);
  radius_ = FitRadius(grid_, evidence);
  if (AddApposed(rays, radius_, evidence) > 0) radius_ = FitRadius(grid_, evidence);
  ReportFit(rays, radius_, fallbacks);
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

Eigen::Vector3d FittedCage::Within(const Eigen::Vector3d& point, double outside) const {
  const Polar polar = PolarOf(point);
  const double wall = Radius(polar.azimuth, point.z()), gap = polar.radius - wall;
  if (gap <= 0) return point;
  const double radius = wall + outside * (1 - std::exp(-gap / outside));
  const Eigen::Vector2d moved = polar.axis + radius / polar.radius * (point.head<2>() - polar.axis);
  return {moved.x(), moved.y(), point.z()};
}

double FittedCage::DrawnGap(double gap) {
  if (gap > -kOntoWall) return 0;
  if (gap < -kFreeFromWall) return gap;
  const double t = (-gap - kOntoWall) / (kFreeFromWall - kOntoWall);
  return gap * t * t * (3 - 2 * t);
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
