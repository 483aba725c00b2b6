#include "server/anatomy/meshing/remesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "server/anatomy/meshing/edge_collapse.h"
#include "server/anatomy/meshing/edge_flips.h"

namespace phrenic::anatomy {
namespace {

Eigen::Vector3d Gradient(const Field& field, const Eigen::Vector3d& x) {
  constexpr double kStep = 0.05;
  Eigen::Vector3d gradient;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(k);
    gradient[k] = (field(x + step) - field(x - step)) / (2 * kStep);
  }
  return gradient;
}

// Returns x after one Newton step towards the zero level set, at most `reach` long.
Eigen::Vector3d Project(const Field& field, const Eigen::Vector3d& x, double reach) {
  const Eigen::Vector3d gradient = Gradient(field, x);
  const double square = gradient.squaredNorm();
  if (square < 1e-6) return x;
  const Eigen::Vector3d step = -field(x) / square * gradient;
  const double length = step.norm();
  return x + (length > reach ? reach / length : 1.0) * step;
}

// Sums over the triangles at a vertex (its one-ring).
struct Ring {
  Eigen::Vector3d centroids = Eigen::Vector3d::Zero();  // area-weighted
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double area = 0;
};

std::vector<Ring> Rings(const std::vector<Eigen::Vector3d>& points, const Triangles& triangles) {
  std::vector<Ring> rings(points.size());
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    const Eigen::Vector3i v = triangles.col(t);
    const Eigen::Vector3d normal = (points[v[1]] - points[v[0]]).cross(points[v[2]] - points[v[0]]);
    const double area = normal.norm();
    for (int k = 0; k < 3; ++k) {
      rings[v[k]].centroids += area / 3 * (points[v[0]] + points[v[1]] + points[v[2]]);
      rings[v[k]].normal += normal;
      rings[v[k]].area += area;
    }
  }
  return rings;
}

// Moves each vertex towards the area centroid of its one-ring, tangentially, and projects it back onto the surface.
void Relax(const Field& field, double edge_length, const Triangles& triangles, std::vector<Eigen::Vector3d>& points) {
  const std::vector<Ring> rings = Rings(points, triangles);
  for (size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d normal = rings[i].normal.normalized();
    const Eigen::Vector3d shift = rings[i].centroids / rings[i].area - points[i];
    const Eigen::Vector3d moved = points[i] + 0.6 * (shift - normal * normal.dot(shift));
    points[i] = Project(field, moved, 0.3 * edge_length);
  }
}

}  // namespace

Mesh Remesh(const Field& field, const Mesh& fine, double edge_length) {
  constexpr int kRounds = 6, kRelaxations = 3;
  std::vector<Eigen::Vector3d> points;
  for (Eigen::Index i = 0; i < fine.vertices.cols(); ++i) points.emplace_back(fine.vertices.col(i));
  Triangles triangles = fine.triangles;
  for (int round = 0; round < kRounds; ++round) {
    CollapseShortEdges(0.72 * edge_length, 1.5 * edge_length, points, triangles);
    EdgeFlips flips(triangles);
    for (int i = 0; i < kRelaxations; ++i) {
      flips.ToDelaunay(points);
      Relax(field, edge_length, triangles, points);
    }
  }
  Mesh mesh;
  mesh.triangles = triangles;
  mesh.vertices.resize(3, static_cast<Eigen::Index>(points.size()));
  for (size_t i = 0; i < points.size(); ++i) mesh.vertices.col(static_cast<Eigen::Index>(i)) = points[i];
  return mesh;
}

}  // namespace phrenic::anatomy
