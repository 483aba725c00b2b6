#include "server/anatomy/sheet_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <utility>

#include "server/anatomy/meshing/edge_flips.h"
#include "server/anatomy/meshing/plane_delaunay.h"
#include "server/anatomy/meshing/plane_region.h"
#include "server/anatomy/meshing/spaced_points.h"
#include "server/mesh/locality.h"
#include "server/mesh/topology.h"

namespace phrenic::anatomy {
namespace {

using Plane = std::vector<Eigen::Vector2d>;

// Resamples a closed loop so that all steps have the same length relative to the target edge length.
Plane Resample(const SheetDomain& domain, const Plane& loop) {
  std::vector<double> passed = {0};
  for (size_t i = 0; i < loop.size(); ++i) {
    const Eigen::Vector3d a = domain.map(loop[i]), b = domain.map(loop[(i + 1) % loop.size()]);
    passed.push_back(passed.back() + (b - a).norm() / domain.edge_length((a + b) / 2));
  }
  const int count = std::max(8, static_cast<int>(std::lround(passed.back())));
  Plane even;
  size_t segment = 0;
  for (int i = 0; i < count; ++i) {
    const double target = passed.back() * i / count;
    while (passed[segment + 1] <= target) ++segment;
    const double t = (target - passed[segment]) / (passed[segment + 1] - passed[segment]);
    even.push_back((1 - t) * loop[segment] + t * loop[(segment + 1) % loop.size()]);
  }
  return even;
}

// Returns the maximum surface area per unit of plane area, in squared target edge lengths.
double MaxAreaDensity(const SheetDomain& domain, const PlaneRegion& region) {
  constexpr int kSamples = 2000;
  constexpr double kRelativeStep = 1e-4;  // of the extent
  const Eigen::Vector2d extent = region.high() - region.low();
  const Eigen::Vector2d across(kRelativeStep * extent.x(), 0), along(0, kRelativeStep * extent.y());
  double most = 0;
  for (int i = 1; i <= kSamples; ++i) {
    const Eigen::Vector2d p = region.low() + extent.cwiseProduct(QuasiRandom(i));
    if (!region.Contains(p)) continue;
    const Eigen::Vector3d x = domain.map(p), u = domain.map(p + across) - x, v = domain.map(p + along) - x;
    const double area = u.cross(v).norm() / (across.x() * along.y()), length = domain.edge_length(x);
    most = std::max(most, area / (length * length));
  }
  return most;
}

// Adds interior points that keep a minimum distance from each other and from the boundary (dart throwing).
void Fill(const SheetDomain& domain, const PlaneRegion& region, Sheet& sheet) {
  constexpr double kApart = 0.8;  // relative to the edge length; a hexagonal lattice of that density has about 1
  constexpr int kCandidatesPerArea = 12;  // per squared edge length of surface
  double smallest = domain.edge_length(sheet.points[0]);
  for (const Eigen::Vector3d& x : sheet.points) smallest = std::min(smallest, domain.edge_length(x));
  SpacedPoints spaced(domain.edge_length(Eigen::Vector3d::Zero()), kApart, smallest);
  for (const Eigen::Vector3d& x : sheet.points) spaced.Add(x, domain.edge_length(x));
  const Eigen::Vector2d extent = region.high() - region.low();
  const auto tries = static_cast<int64_t>(kCandidatesPerArea * extent.prod() * MaxAreaDensity(domain, region));
  for (int64_t i = 1; i <= tries; ++i) {
    const Eigen::Vector2d p = region.low() + extent.cwiseProduct(QuasiRandom(i));
    if (!region.Contains(p)) continue;
    const Eigen::Vector3d x = domain.map(p);
    if (!spaced.TryAdd(x, domain.edge_length(x))) continue;
    sheet.plane.push_back(p);
    sheet.points.push_back(x);
  }
}

// Returns the triangles whose centroid is in the region.
Triangles Inside(const PlaneRegion& region, const Plane& plane, const Triangles& all) {
  Triangles kept(3, all.cols());
  Eigen::Index count = 0;
  for (Eigen::Index t = 0; t < all.cols(); ++t) {
    const Eigen::Vector2d centre = (plane[all(0, t)] + plane[all(1, t)] + plane[all(2, t)]) / 3;
    if (region.Contains(centre)) kept.col(count++) = all.col(t);
  }
  kept.conservativeResize(3, count);
  return kept;
}

double Cross(const Eigen::Vector2d& u, const Eigen::Vector2d& v) { return u.x() * v.y() - u.y() * v.x(); }

// Returns the triangles at each vertex.
std::vector<std::vector<int>> Fans(size_t vertices, const Triangles& triangles) {
  std::vector<std::vector<int>> fans(vertices);
  for (int t = 0; t < static_cast<int>(triangles.cols()); ++t) {
    for (int k = 0; k < 3; ++k) fans[triangles(k, t)].push_back(t);
  }
  return fans;
}

// Returns the mean centroid of the fan's triangles, weighted by area in squared target edge lengths.
Eigen::Vector2d Centroid(const SheetDomain& domain, const Sheet& sheet, const std::vector<int>& fan) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double weights = 0;
  for (const int t : fan) {
    const Eigen::Vector3i v = sheet.triangles.col(t);
    const Eigen::Vector3d &a = sheet.points[v[0]], &b = sheet.points[v[1]], &c = sheet.points[v[2]];
    const double target = domain.edge_length(a);
    const double weight = (b - a).cross(c - a).norm() / (target * target);
    sum += weight / 3 * (sheet.plane[v[0]] + sheet.plane[v[1]] + sheet.plane[v[2]]);
    weights += weight;
  }
  return sum / weights;
}

// True if the fan's triangles stay counter-clockwise when the vertex moves.
bool StaysCounterClockwise(const Sheet& sheet, const std::vector<int>& fan, int vertex, const Eigen::Vector2d& moved) {
  for (const int t : fan) {
    std::array<Eigen::Vector2d, 3> p;
    for (int k = 0; k < 3; ++k) p[k] = sheet.triangles(k, t) == vertex ? moved : sheet.plane[sheet.triangles(k, t)];
    const double now = Cross(p[1] - p[0], p[2] - p[0]);
    if (now <= 1e-9) return false;
  }
  return true;
}

void Relax(const SheetDomain& domain, int first_free, Sheet& sheet) {
  const std::vector<std::vector<int>> fans = Fans(sheet.plane.size(), sheet.triangles);
  for (int i = first_free; i < static_cast<int>(sheet.plane.size()); ++i) {
    const Eigen::Vector2d moved = Centroid(domain, sheet, fans[i]);
    if (!StaysCounterClockwise(sheet, fans[i], i, moved)) continue;
    sheet.plane[i] = moved;
    sheet.points[i] = domain.map(moved);
  }
}

// Renumbers the vertices so that neighbours are close in memory; drops unused ones.
Sheet InCacheOrder(const Sheet& sheet) {
  const std::vector<int> order =
      CuthillMcKeeOrder(TriangleEdges(sheet.triangles), static_cast<int>(sheet.plane.size()));
  std::vector<int> number(sheet.plane.size(), -1);
  Sheet ordered{.plane = {}, .points = {}, .triangles = sheet.triangles, .loops = sheet.loops};
  for (const int vertex : order) {
    number[vertex] = static_cast<int>(ordered.plane.size());
    ordered.plane.push_back(sheet.plane[vertex]);
    ordered.points.push_back(sheet.points[vertex]);
  }
  for (int& corner : ordered.triangles.reshaped()) corner = number[corner];
  for (std::vector<int>& loop : ordered.loops) {
    for (int& vertex : loop) vertex = number[vertex];
  }
  return ordered;
}

}  // namespace

Sheet MeshSheet(const SheetDomain& domain) {
  constexpr int kRounds = 30;
  Sheet sheet;
  std::vector<Plane> boundary;
  for (const Plane& loop : domain.loops) {
    boundary.push_back(Resample(domain, loop));
    sheet.loops.emplace_back();
    for (const Eigen::Vector2d& p : boundary.back()) {
      sheet.loops.back().push_back(static_cast<int>(sheet.plane.size()));
      sheet.plane.push_back(p);
      sheet.points.push_back(domain.map(p));
    }
  }
  const auto first_free = static_cast<int>(sheet.plane.size());
  const PlaneRegion region(boundary);
  Fill(domain, region, sheet);
  sheet.triangles = Inside(region, sheet.plane, PlaneDelaunay(sheet.plane));
  EdgeFlips flips(sheet.triangles);
  for (int round = 0; round < kRounds; ++round) {
    flips.ToDelaunay(sheet.plane, sheet.points);
    Relax(domain, first_free, sheet);
  }
  flips.ToDelaunay(sheet.plane, sheet.points);
  return InCacheOrder(sheet);
}

std::vector<std::pair<int, int>> BoundaryEdges(const Sheet& sheet) {
  std::set<std::pair<int, int>> along;
  for (Eigen::Index t = 0; t < sheet.triangles.cols(); ++t) {
    for (int k = 0; k < 3; ++k) along.emplace(sheet.triangles(k, t), sheet.triangles((k + 1) % 3, t));
  }
  std::vector<std::pair<int, int>> boundary;
  for (const auto& [a, b] : along) {
    if (!along.contains({b, a})) boundary.emplace_back(a, b);
  }
  return boundary;
}

}  // namespace phrenic::anatomy
