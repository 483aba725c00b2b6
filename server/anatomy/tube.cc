#include "server/anatomy/tube.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace phrenic::anatomy {
namespace {

// Barry and Goldman's recursive evaluation, with centripetal knots: spaced by the square root of the chord lengths.
Eigen::Vector3d CatmullRom(const std::array<Eigen::Vector3d, 4>& p, double t) {
  std::array<double, 4> knot{};
  for (int i = 1; i < 4; ++i) knot[i] = knot[i - 1] + std::sqrt(std::max(1e-9, (p[i] - p[i - 1]).norm()));
  const double u = knot[1] + t * (knot[2] - knot[1]);
  const auto blend = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b, double from, double to) {
    return Eigen::Vector3d(((to - u) * a + (u - from) * b) / (to - from));
  };
  const Eigen::Vector3d a1 = blend(p[0], p[1], knot[0], knot[1]), a2 = blend(p[1], p[2], knot[1], knot[2]);
  const Eigen::Vector3d a3 = blend(p[2], p[3], knot[2], knot[3]);
  return blend(blend(a1, a2, knot[0], knot[2]), blend(a2, a3, knot[1], knot[3]), knot[1], knot[2]);
}

// Samples the curve at 24 parameters per span.
Curve Dense(const Curve& through) {
  constexpr int kSteps = 24;
  const auto n = static_cast<int>(through.size());
  Curve dense;
  for (int i = 0; i + 1 < n; ++i) {
    const Eigen::Vector3d before = i > 0 ? through[i - 1] : Eigen::Vector3d(2 * through[0] - through[1]);
    const Eigen::Vector3d after = i + 2 < n ? through[i + 2] : Eigen::Vector3d(2 * through[n - 1] - through[n - 2]);
    for (int k = 0; k < kSteps; ++k) {
      dense.push_back(CatmullRom({before, through[i], through[i + 1], after}, static_cast<double>(k) / kSteps));
    }
  }
  dense.push_back(through.back());
  return dense;
}

struct Profile {
  Eigen::Vector3d centre, broad, thin;  // semi-axes as vectors
};

Profile RingAt(const Curve& path, size_t i, const TubeSection& section) {
  const Eigen::Vector3d along = path[std::min(i + 1, path.size() - 1)] - path[i > 0 ? i - 1 : 0];
  const Eigen::Vector3d broad = section.thin.cross(along).normalized();
  const Eigen::Vector3d thin = along.cross(broad).normalized();
  return {path[i], section.half_broad * broad, section.half_thin * thin};
}

// Returns one ring per path point and two more at each end that round it off.
std::vector<Profile> Rings(const Curve& path, const SectionAt& section) {
  constexpr double kAngles[] = {62, 34};  // degrees along the quarter circle at an end
  std::vector<Profile> rings;
  const double last = static_cast<double>(path.size()) - 1;
  for (size_t i = 0; i < path.size(); ++i) {
    rings.push_back(RingAt(path, i, section(static_cast<double>(i) / last, path[i])));
  }
  const auto rounded = [&](const Profile& ring, const Eigen::Vector3d& outwards, double degrees) {
    const double reach = ring.thin.norm() * std::sin(degrees * std::numbers::pi / 180);
    const double inset = ring.thin.norm() * (1 - std::cos(degrees * std::numbers::pi / 180));
    const double broad = 1 - inset / ring.broad.norm(), thin = 1 - inset / ring.thin.norm();
    return Profile{ring.centre + reach * outwards, broad * ring.broad, thin * ring.thin};
  };
  const Profile first = rings.front(), end = rings.back();
  const Eigen::Vector3d before = (path[0] - path[1]).normalized();
  const Eigen::Vector3d behind = (path[path.size() - 1] - path[path.size() - 2]).normalized();
  rings.insert(rings.begin(), rounded(first, before, kAngles[1]));
  rings.insert(rings.begin(), rounded(first, before, kAngles[0]));
  rings.push_back(rounded(end, behind, kAngles[1]));
  rings.push_back(rounded(end, behind, kAngles[0]));
  return rings;
}

// Returns `count` parameter angles at equal arc lengths of the ellipse, offset by `shift` steps.
std::vector<double> EvenAngles(double broad, double thin, int count, double shift) {
  constexpr int kFine = 720;
  std::vector<double> passed = {0};
  for (int i = 0; i < kFine; ++i) {
    const double angle = 2 * std::numbers::pi * (i + 0.5) / kFine;
    passed.push_back(passed.back() + std::hypot(broad * std::sin(angle), thin * std::cos(angle)));
  }
  std::vector<double> angles;
  int at = 0;
  for (int i = 0; i < count; ++i) {
    const double target = passed.back() * (i + shift) / count;
    while (passed[at + 1] <= target) ++at;
    angles.push_back(2 * std::numbers::pi * (at + (target - passed[at]) / (passed[at + 1] - passed[at])) / kFine);
  }
  return angles;
}

Points RingPoints(const std::vector<Profile>& rings, int around) {
  Points points(3, static_cast<Eigen::Index>(rings.size()) * around);
  Eigen::Index column = 0;
  for (size_t r = 0; r < rings.size(); ++r) {
    const double shift = r % 2 == 0 ? 0 : 0.5;
    for (const double angle : EvenAngles(rings[r].broad.norm(), rings[r].thin.norm(), around, shift)) {
      points.col(column++) = rings[r].centre + std::cos(angle) * rings[r].broad + std::sin(angle) * rings[r].thin;
    }
  }
  return points;
}

// Closes an end ring with a zigzag of triangles across its thin direction.
void ZipEnd(int first, int around, bool reversed, std::vector<Eigen::Vector3i>& triangles) {
  int low = 0, high = around - 1;
  const auto add = [&](int a, int b, int c) {
    if (reversed) std::swap(b, c);
    triangles.emplace_back(first + a, first + b, first + c);
  };
  while (high - low >= 2) {
    add(low, low + 1, high);
    ++low;
    if (high - low < 2) break;
    add(low, high - 1, high);
    --high;
  }
}

Triangles RingTriangles(int rings, int around) {
  std::vector<Eigen::Vector3i> triangles;
  for (int r = 0; r + 1 < rings; ++r) {
    const int here = r * around, next = here + around;
    for (int i = 0; i < around; ++i) {
      const int j = (i + 1) % around;
      if (r % 2 == 0) {  // the next ring is offset by half a step
        triangles.emplace_back(here + i, here + j, next + i);
        triangles.emplace_back(here + j, next + j, next + i);
      } else {
        triangles.emplace_back(here + i, here + j, next + j);
        triangles.emplace_back(here + i, next + j, next + i);
      }
    }
  }
  ZipEnd(0, around, true, triangles);
  ZipEnd((rings - 1) * around, around, false, triangles);
  Triangles result(3, static_cast<Eigen::Index>(triangles.size()));
  for (size_t t = 0; t < triangles.size(); ++t) result.col(static_cast<Eigen::Index>(t)) = triangles[t];
  return result;
}

// Ramanujan's approximation of the ellipse's perimeter.
double Perimeter(const TubeSection& s) {
  return std::numbers::pi * (3 * (s.half_broad + s.half_thin) -
                             std::sqrt((3 * s.half_broad + s.half_thin) * (s.half_broad + 3 * s.half_thin)));
}

}  // namespace

double Length(const Curve& curve) {
  double length = 0;
  for (size_t i = 0; i + 1 < curve.size(); ++i) length += (curve[i + 1] - curve[i]).norm();
  return length;
}

Curve SmoothCurve(const Curve& through, int count) {
  const Curve dense = Dense(through);
  const double length = Length(dense);
  Curve even;
  size_t at = 0;
  double passed = 0;
  for (int i = 0; i + 1 < count; ++i) {
    const double target = length * i / (count - 1);
    while (passed + (dense[at + 1] - dense[at]).norm() <= target) {
      passed += (dense[at + 1] - dense[at]).norm();
      ++at;
    }
    const double t = (target - passed) / (dense[at + 1] - dense[at]).norm();
    even.emplace_back((1 - t) * dense[at] + t * dense[at + 1]);
  }
  even.push_back(dense.back());
  return even;
}

Mesh Tube(const Curve& through, const SectionAt& section, double edge_length) {
  const double length = Length(Dense(through));
  const int stations = std::max(3, 1 + static_cast<int>(std::lround(length / (0.9 * edge_length))));
  const Curve path = SmoothCurve(through, stations);
  const size_t middle = path.size() / 2;
  const double perimeter = Perimeter(section(0.5, path[middle]));
  const int around = std::max(6, 2 * static_cast<int>(std::lround(perimeter / (2 * edge_length))));
  const std::vector<Profile> rings = Rings(path, section);
  Mesh mesh;
  mesh.vertices = RingPoints(rings, around);
  mesh.triangles = RingTriangles(static_cast<int>(rings.size()), around);
  return mesh;
}

Mesh Mirrored(Mesh mesh) {
  mesh.vertices.row(0) *= -1;
  mesh.triangles.row(1).swap(mesh.triangles.row(2));
  return mesh;
}

}  // namespace phrenic::anatomy
