#include "server/physiology/cavity.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "server/mesh/topology.h"
#include "server/physiology/diaphragm_border.h"

namespace phrenic::physiology {
namespace {

constexpr int kParts = 8;       // into which an edge of the wall is divided where the border cuts it
constexpr double kFlat = 1e-3;  // [m]

// Returns six times the signed volume of the cone over a triangle.
double Cone(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) { return a.dot(b.cross(c)); }

double ConesOver(const ConstPoints& x, const Triangles& triangles, const Eigen::Vector3d& tip) {
  double sum = 0;
  for (const auto t : triangles.colwise()) sum += Cone(x.col(t[0]) - tip, x.col(t[1]) - tip, x.col(t[2]) - tip);
  return sum / 6;
}

// Returns the share of a triangle that lies above the border.
double ShareAbove(const DiaphragmBorder& border, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                  const Eigen::Vector3d& c) {
  int above = 0, all = 0;
  for (int i = 0; i < kParts; ++i) {
    for (int j = 0; i + j < kParts; ++j, ++all) {
      const double u = (i + 1.0 / 3) / kParts, v = (j + 1.0 / 3) / kParts;
      above += border.IsBelow((1 - u - v) * a + u * b + v * c) ? 1 : 0;
    }
  }
  return static_cast<double>(above) / all;
}

// Returns the volume of the cones over the wall above the border, turned outward.
double ConesOverWall(const Mesh& wall, const ConstPoints& now, const DiaphragmBorder& border,
                     const Eigen::Vector3d& tip) {
  double above = 0, all = 0;
  for (const Eigen::Vector3i t : wall.triangles.colwise()) {
    const Points& rest = wall.vertices;
    const double share = ShareAbove(border, rest.col(t[0]), rest.col(t[1]), rest.col(t[2]));
    above += share * Cone(now.col(t[0]) - tip, now.col(t[1]) - tip, now.col(t[2]) - tip) / 6;
    all += Cone(rest.col(t[0]) - tip, rest.col(t[1]) - tip, rest.col(t[2]) - tip);
  }
  return all < 0 ? -above : above;
}

// Returns the volume of the cones over the polygon of the wall's highest vertices.
double ConesOverTop(const Mesh& wall, const ConstPoints& now, const DiaphragmBorder& border,
                    const Eigen::Vector3d& tip) {
  const double top = wall.vertices.row(2).maxCoeff();
  std::map<double, Eigen::Vector3d> ring;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const int i : BoundaryVertices(wall.triangles)) {
    if (wall.vertices(2, i) < top - kFlat) continue;
    ring[border.Azimuth(wall.vertices.col(i))] = now.col(i);
    middle += now.col(i);
  }
  if (ring.size() < 3) return 0;
  middle /= static_cast<double>(ring.size());
  double sum = 0;
  for (auto at = ring.begin(); at != ring.end(); ++at) {
    const auto next = std::next(at) == ring.end() ? ring.begin() : std::next(at);
    sum += Cone(middle - tip, at->second - tip, next->second - tip);
  }
  return sum / 6;
}

}  // namespace

double CavityGrowth(const Model& model, const Parts& parts, const State& from, const State& to) {
  if (parts.wall < 0 || parts.muscle < 0) return kNone;
  const Mesh &sheet = model.bodies[parts.muscle].mesh, &wall = model.bodies[parts.wall].mesh;
  const DiaphragmBorder border(sheet);
  if (!border.exists()) return kNone;
  const Eigen::Vector3d tip = border.Middle() + Eigen::Vector3d(0, 0, sheet.vertices.row(2).minCoeff());
  const double up = ConesOver(sheet.vertices, sheet.triangles, tip) < 0 ? -1 : 1;
  const auto volume = [&](const State& state) {
    const Points around = Placed(model, state, parts.wall);
    return ConesOverWall(wall, around, border, tip) + ConesOverTop(wall, around, border, tip) -
           up * ConesOver(Placed(model, state, parts.muscle), sheet.triangles, tip);
  };
  return volume(to) - volume(from);
}

}  // namespace phrenic::physiology
