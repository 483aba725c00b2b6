#include "server/anatomy/meshing/tube.h"

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

// One ring of the tube: its section in space.
struct Profile {
  Eigen::Vector3d centre, broad, thin, along;  // unit vectors but for the centre
  TubeSection section;
};

Profile RingAt(const Eigen::Vector3d& centre, const Eigen::Vector3d& along, const TubeSection& section) {
  const Eigen::Vector3d broad = section.thin.cross(along).normalized();
  return {centre, broad, along.cross(broad).normalized(), along.normalized(), section};
}

// Returns the profile moved along the curve, its section made smaller by `inset` on all sides.
Profile Moved(const Profile& ring, double along, double inset) {
  Profile moved = ring;
  moved.centre += along * ring.along;
  moved.section.half_broad -= inset;
  moved.section.half_thin -= inset;
  moved.section.bulge *= moved.section.half_thin / ring.section.half_thin;
  return moved;
}

// Returns the rings that end the tube beyond `ring`, the outermost last; `side` is 1 at the end and -1 at the start of
// the curve.
std::vector<Profile> EndRings(const Profile& ring, TubeEnd end, int side) {
  const double thick = ring.section.half_thin;
  if (end == TubeEnd::kStraight) return {Moved(ring, 0, 0.45 * thick)};
  std::vector<Profile> rings;
  for (const double degrees : {32, 62}) {  // along the quarter circle
    const double angle = degrees * std::numbers::pi / 180;
    rings.push_back(Moved(ring, side * thick * std::sin(angle), thick * (1 - std::cos(angle))));
  }
  return rings;
}

// Returns a ring close to a straight end, which keeps the crease there narrow in the shading; none at a round end.
std::vector<Profile> CreaseRing(const Profile& ring, TubeEnd end, int side) {
  if (end == TubeEnd::kRound) return {};
  return {Moved(ring, -0.15 * side * ring.section.half_thin, 0)};
}

constexpr int kFine = 8;  // steps of the curve between rings, for their directions

// Returns one ring per kFine points of the curve and those that end the tube.
std::vector<Profile> Rings(const TubeShape& shape, const Curve& curve) {
  std::vector<Profile> inner;
  const size_t last = curve.size() - 1;
  for (size_t i = 0; i <= last; i += kFine) {
    Eigen::Vector3d along = curve[std::min(i + 1, last)] - curve[i > 0 ? i - 1 : 0];
    if (i == 0 && !shape.start.isZero()) along = shape.start;
    const TubeSection section = shape.section(static_cast<double>(i) / static_cast<double>(last), curve[i]);
    inner.push_back(RingAt(curve[i], along, section));
  }
  std::vector<Profile> rings = EndRings(inner.front(), shape.first, -1);
  std::reverse(rings.begin(), rings.end());
  const auto append = [&rings](const std::vector<Profile>& more) {
    rings.insert(rings.end(), more.begin(), more.end());
  };
  rings.push_back(inner.front());
  append(CreaseRing(inner.front(), shape.first, -1));
  rings.insert(rings.end(), inner.begin() + 1, inner.end() - 1);
  append(CreaseRing(inner.back(), shape.last, 1));
  rings.push_back(inner.back());
  append(EndRings(inner.back(), shape.last, 1));
  return rings;
}

Eigen::Vector3d OnRing(const Profile& ring, double angle) {
  const TubeSection& s = ring.section;
  const auto flattened = [&s](double x) { return std::copysign(std::pow(std::abs(x), 1 - s.flatness), x); };
  const double cosine = flattened(std::cos(angle)), sine = flattened(std::sin(angle));
  const double thick = s.half_thin * (1 - s.taper * cosine) + s.bulge * std::max(0.0, sine);
  return ring.centre + s.half_broad * cosine * ring.broad + thick * sine * ring.thin;
}

Points RingPoints(const std::vector<Profile>& rings, int around) {
  Points points(3, static_cast<Eigen::Index>(rings.size()) * around);
  Eigen::Index column = 0;
  for (const Profile& ring : rings) {
    for (int i = 0; i < around; ++i) points.col(column++) = OnRing(ring, 2 * std::numbers::pi * i / around);
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
      if (i % 2 == 0) {  // diagonals that alternate favour no sense of rotation
        triangles.emplace_back(here + i, here + j, next + j);
        triangles.emplace_back(here + i, next + j, next + i);
      } else {
        triangles.emplace_back(here + i, here + j, next + i);
        triangles.emplace_back(here + j, next + j, next + i);
      }
    }
  }
  ZipEnd(0, around, true, triangles);
  ZipEnd((rings - 1) * around, around, false, triangles);
  Triangles result(3, static_cast<Eigen::Index>(triangles.size()));
  for (size_t t = 0; t < triangles.size(); ++t) result.col(static_cast<Eigen::Index>(t)) = triangles[t];
  return result;
}

int VerticesAround(const TubeShape& shape, const Curve& curve, double edge_length) {
  const TubeSection middle = shape.section(0.5, curve[curve.size() / 2]);
  const double radius = shape.radius > 0 ? shape.radius : (middle.half_broad + middle.half_thin) / 2;
  return std::max(10, 2 * static_cast<int>(std::lround(std::numbers::pi * radius / (0.6 * edge_length))));
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

Mesh Tube(const TubeShape& shape, double edge_length) {
  const double length = Length(Dense(shape.through));
  constexpr double kFarthest = 12;  // between rings [mm]; more gives slivers where a ring has many vertices
  const double step = std::min(1.3 * edge_length, kFarthest);
  const int spans = std::max(3, static_cast<int>(std::lround(length / step)));
  const Curve curve = SmoothCurve(shape.through, kFine * spans + 1);
  const int around = VerticesAround(shape, curve, edge_length);
  const std::vector<Profile> rings = Rings(shape, curve);
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
