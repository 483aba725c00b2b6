#include "server/anatomy/meshing/implicit_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "absl/container/flat_hash_map.h"
#include "absl/container/inlined_vector.h"
#include "server/anatomy/meshing/remesh.h"
#include "server/mesh/renumber.h"
#include "server/mesh/topology.h"

namespace phrenic::anatomy {
namespace {

// Marching tetrahedra on a cubic grid whose nodes are sampled once.
class MarchingTetrahedra {
 public:
  MarchingTetrahedra(const Field& field, const Box& box, double cell) : low_(box.low), cell_(cell) {
    size_ = ((box.high - box.low) / cell).array().ceil().cast<int>() + 2;
    values_.resize(static_cast<size_t>(size_.prod()));
    for (int k = 0; k < size_.z(); ++k) {
      for (int j = 0; j < size_.y(); ++j) {
        for (int i = 0; i < size_.x(); ++i) {
          const int node = Node({i, j, k});
          const bool border = ((Eigen::Array3i(i, j, k) == 0) || (Eigen::Array3i(i, j, k) == size_.array() - 1)).any();
          const double value = field(PositionOf(node));
          values_[node] = border ? std::max(value, 0.1 * cell) : value;  // closes the surface at the box
        }
      }
    }
  }

  Mesh Run() {
    for (int k = 0; k + 1 < size_.z(); ++k) {
      for (int j = 0; j + 1 < size_.y(); ++j) {
        for (int i = 0; i + 1 < size_.x(); ++i) Cube({i, j, k});
      }
    }
    Mesh mesh;
    mesh.vertices.resize(3, static_cast<Eigen::Index>(points_.size()));
    for (size_t i = 0; i < points_.size(); ++i) mesh.vertices.col(static_cast<Eigen::Index>(i)) = points_[i];
    mesh.triangles.resize(3, static_cast<Eigen::Index>(triangles_.size()));
    for (size_t t = 0; t < triangles_.size(); ++t) mesh.triangles.col(static_cast<Eigen::Index>(t)) = triangles_[t];
    return mesh;
  }

 private:
  int Node(const Eigen::Vector3i& at) const { return (at.z() * size_.y() + at.y()) * size_.x() + at.x(); }

  Eigen::Vector3d PositionOf(int node) const {
    const int i = node % size_.x(), j = node / size_.x() % size_.y(), k = node / (size_.x() * size_.y());
    return low_ + cell_ * (Eigen::Vector3d(i, j, k) - Eigen::Vector3d::Constant(0.5));
  }

  bool In(int node) const { return values_[node] < 0; }

  void Cube(const Eigen::Vector3i& at) {
    constexpr int kOrders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    std::array<int, 8> corners{};
    int inside = 0;
    for (int c = 0; c < 8; ++c) {
      corners[c] = Node(at + Eigen::Vector3i(c & 1, c >> 1 & 1, c >> 2));
      inside += In(corners[c]) ? 1 : 0;
    }
    if (inside == 0 || inside == 8) return;
    for (const auto& order : kOrders) {
      const int a = 1 << order[0], b = a | 1 << order[1];
      Tetrahedron({corners[0], corners[a], corners[b], corners[7]});
    }
  }

  void Tetrahedron(const std::array<int, 4>& nodes) {
    absl::InlinedVector<int, 4> in, out;
    for (const int node : nodes) (In(node) ? in : out).push_back(node);
    if (in.empty() || out.empty()) return;
    if (in.size() == 1) {
      Triangle(in[0], out[0], CutPoint(in[0], out[0]), CutPoint(in[0], out[1]), CutPoint(in[0], out[2]));
    } else if (out.size() == 1) {
      Triangle(in[0], out[0], CutPoint(in[0], out[0]), CutPoint(in[1], out[0]), CutPoint(in[2], out[0]));
    } else {
      const int p = CutPoint(in[0], out[0]), q = CutPoint(in[0], out[1]), r = CutPoint(in[1], out[1]),
                s = CutPoint(in[1], out[0]);
      Triangle(in[0], out[0], p, q, r);
      Triangle(in[0], out[0], p, r, s);
    }
  }

  // Adds a triangle facing from the inner node to the outer one, which lie on opposite sides of it.
  void Triangle(int in, int out, int a, int b, int c) {
    const Eigen::Vector3d normal = (points_[b] - points_[a]).cross(points_[c] - points_[a]);
    const double side = normal.dot(PositionOf(out) - points_[a]) - normal.dot(PositionOf(in) - points_[a]);
    triangles_.emplace_back(side > 0 ? Eigen::Vector3i(a, b, c) : Eigen::Vector3i(a, c, b));
  }

  // Returns the vertex where the edge between two nodes crosses zero, linearly interpolated. It stays 8 % of the edge
  // away from the nodes, which avoids degenerate triangles.
  int CutPoint(int a, int b) {
    const int64_t key = static_cast<int64_t>(std::min(a, b)) * size_.prod() + std::max(a, b);
    const auto [found, added] = cuts_.try_emplace(key, static_cast<int>(points_.size()));
    if (added) {
      const int low = std::min(a, b), high = std::max(a, b);
      const double t = std::clamp(values_[low] / (values_[low] - values_[high]), 0.08, 0.92);
      points_.emplace_back((1 - t) * PositionOf(low) + t * PositionOf(high));
    }
    return found->second;
  }

  Eigen::Vector3d low_;
  double cell_;
  Eigen::Vector3i size_;
  std::vector<double> values_;
  absl::flat_hash_map<int64_t, int> cuts_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<Eigen::Vector3i> triangles_;
};

// Keeps the connected component with the most triangles. Drops fragments where the field is thinner than a cell.
Mesh LargestComponent(Mesh mesh) {
  const std::vector<std::vector<int>> components = Components(mesh);
  const auto largest = std::max_element(components.begin(), components.end(),
                                        [](const auto& a, const auto& b) { return a.size() < b.size(); });
  if (largest == components.end()) return mesh;
  std::vector<bool> keep(static_cast<size_t>(mesh.triangles.cols()), false);
  for (const int t : *largest) keep[t] = true;
  KeepTriangles(keep, mesh);
  DropUnusedVertices(mesh);
  return mesh;
}

}  // namespace

Mesh Polygonise(const Field& field, const Box& box, double cell) {
  return LargestComponent(MarchingTetrahedra(field, box, cell).Run());
}

Mesh ImplicitSurface(const Field& field, const Box& box, double edge_length, double detail) {
  return Remesh(field, Polygonise(field, box, std::min(0.6 * edge_length, detail)), edge_length);
}

}  // namespace phrenic::anatomy
