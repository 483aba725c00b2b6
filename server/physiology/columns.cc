#include "server/physiology/columns.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "server/physiology/parts.h"

namespace phrenic::physiology {
namespace {

constexpr double kBesideMidline = 0.035, kBehind = 0.04;  // [m]
constexpr double kUpwards = 0.3;                          // least z of a unit normal; the steep rim has less
constexpr int kSections = 6, kSectionReach = 9;           // points on each side of the apex
constexpr double kSpacing = 0.005;                        // [m]

Eigen::Vector3d AreaVector(const ConstPoints& x, const Eigen::Vector3i& t) {
  const Eigen::Vector3d a = x.col(t[0]), b = x.col(t[1]), c = x.col(t[2]);
  return (b - a).cross(c - a) / 2;
}

// Returns the height of a triangle above (x, y); kNone beside it.
double HeightOver(const ConstPoints& v, const Eigen::Vector3i& t, double x, double y) {
  const double ax = v(0, t[0]) - x, bx = v(0, t[1]) - x, cx = v(0, t[2]) - x;
  if ((ax > 0 && bx > 0 && cx > 0) || (ax < 0 && bx < 0 && cx < 0)) return kNone;
  const double ay = v(1, t[0]) - y, by = v(1, t[1]) - y, cy = v(1, t[2]) - y;
  if ((ay > 0 && by > 0 && cy > 0) || (ay < 0 && by < 0 && cy < 0)) return kNone;
  const double u = bx * cy - by * cx, w = cx * ay - cy * ax, z = ax * by - ay * bx, sum = u + w + z;
  if (sum == 0 || u * sum < 0 || w * sum < 0 || z * sum < 0) return kNone;
  return (u * v(2, t[0]) + w * v(2, t[1]) + z * v(2, t[2])) / sum;
}

// Returns how far a profile of heights lies below the straight line between two of its points, at most.
double DepthUnderChords(const std::vector<double>& z) {
  double depth = 0;
  const int n = static_cast<int>(z.size());
  for (int i = 0; i < n; ++i) {
    for (int j = i + 2; j < n; ++j) {
      for (int k = i + 1; k < j; ++k) depth = std::max(depth, z[i] + (z[j] - z[i]) * (k - i) / (j - i) - z[k]);
    }
  }
  return depth;
}

}  // namespace

double TopOfColumn(const ConstPoints& vertices, const Triangles& triangles, double x, double y) {
  double top = kNone;
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    const double z = HeightOver(vertices, triangles.col(t), x, y);
    if (std::isfinite(z) && !(z < top)) top = std::isfinite(top) ? std::max(top, z) : z;
  }
  return top;
}

Columns::Columns(const Mesh& rest) : rest_(rest) {
  for (const bool left : {false, true}) {
    double highest = -HUGE_VAL;
    Eigen::Vector2d apex(left ? kBesideMidline : -kBesideMidline, 0);
    for (const auto v : rest.vertices.colwise()) {
      if ((left ? v.x() : -v.x()) <= kBesideMidline || v.z() <= highest) continue;
      highest = v.z(), apex = v.head<2>();
    }
    at_[left ? kLeftApex : kRightApex] = apex;
    at_[left ? kLeftBack : kRightBack] = apex + Eigen::Vector2d(0, kBehind);
  }
  for (int t = 0; t < static_cast<int>(rest.triangles.cols()); ++t) {
    if (AreaVector(rest.vertices, rest.triangles.col(t)).normalized().z() > kUpwards) upper_.push_back(t);
  }
}

std::array<double, Columns::kCount> Columns::Heights(const ConstPoints& sheet) const {
  std::array<double, kCount> heights{};
  for (size_t c = 0; c < kCount; ++c) heights[c] = TopOfColumn(sheet, rest_.triangles, at_[c].x(), at_[c].y());
  return heights;
}

template <typename Include>
double Columns::MeanOver(const ConstPoints& from, const ConstPoints& to, const Include& include) const {
  double sum = 0, area = 0;
  for (const int t : upper_) {
    const Eigen::Vector3i corners = rest_.triangles.col(t);
    const Eigen::Vector3d middle = rest_.vertices(Eigen::all, corners).rowwise().mean();
    if (!include(middle)) continue;
    const double weight = AreaVector(rest_.vertices, corners).z();
    for (const int i : corners) sum += weight * (from(2, i) - to(2, i)) / 3;
    area += weight;
  }
  return area > 0 ? sum / area : kNone;
}

double Columns::MeanDescent(const ConstPoints& from, const ConstPoints& to, v1::Side side) const {
  return MeanOver(from, to, [side](const Eigen::Vector3d& at) { return (at.x() > 0) == (side == v1::SIDE_LEFT); });
}

double Columns::BackOverFront(const ConstPoints& from, const ConstPoints& to) const {
  const double middle = (rest_.vertices.row(1).minCoeff() + rest_.vertices.row(1).maxCoeff()) / 2;
  return MeanOver(from, to, [middle](const Eigen::Vector3d& at) { return at.y() > middle; }) /
         MeanOver(from, to, [middle](const Eigen::Vector3d& at) { return at.y() <= middle; });
}

double Columns::Hollow(const ConstPoints& sheet, v1::Side side) const {
  const Eigen::Vector2d& apex = at_[side == v1::SIDE_LEFT ? kLeftApex : kRightApex];
  double least = HUGE_VAL;
  for (int section = 0; section < kSections; ++section) {
    const double turn = std::numbers::pi * section / kSections;
    std::vector<double> heights;
    for (int i = -kSectionReach; i <= kSectionReach; ++i) {
      const Eigen::Vector2d at = apex + kSpacing * i * Eigen::Vector2d(std::cos(turn), std::sin(turn));
      const double z = TopOfColumn(sheet, rest_.triangles, at.x(), at.y());
      if (std::isfinite(z)) heights.push_back(z);
    }
    least = std::min(least, DepthUnderChords(heights));
  }
  return least;
}

double Columns::Swept(const ConstPoints& from, const ConstPoints& to) const {
  double volume = 0;
  for (const int t : upper_) {
    const Eigen::Vector3i corners = rest_.triangles.col(t);
    const Eigen::Vector3d shift = (to(Eigen::all, corners) - from(Eigen::all, corners)).rowwise().mean();
    volume -= shift.dot(AreaVector(from, corners));
  }
  return volume;
}

}  // namespace phrenic::physiology
