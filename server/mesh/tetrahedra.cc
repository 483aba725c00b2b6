#include "server/mesh/tetrahedra.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace phrenic {
namespace {

using LatticeIndex = std::array<int, 3>;

class LatticeMesher {
 public:
  explicit LatticeMesher(const Lattice& lattice) : lattice_(lattice) {}

  // Adds the cell whose lowest corner is `low`.
  void AddCell(const LatticeIndex& low) {
    std::array<int, 4> even{};
    int evens = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const LatticeIndex index = Corner(low, corner);
      if ((index[0] + index[1] + index[2]) % 2 == 0) {
        even[evens++] = Vertex(index);
        continue;
      }
      Add({Vertex(index), Vertex(Corner(low, corner ^ 1)), Vertex(Corner(low, corner ^ 2)),
           Vertex(Corner(low, corner ^ 4))});
    }
    Add(even);
  }

  Mesh Finish() {
    Mesh mesh;
    mesh.vertices.resize(3, static_cast<Eigen::Index>(vertices_.size()));
    for (const auto& [index, i] : vertices_) {
      mesh.vertices.col(i) =
          lattice_.origin + lattice_.cell.cwiseProduct(Eigen::Vector3d(index[0], index[1], index[2]));
    }
    mesh.tetrahedra.resize(4, static_cast<Eigen::Index>(tetrahedra_.size()));
    for (Eigen::Index t = 0; t < mesh.tetrahedra.cols(); ++t) {
      mesh.tetrahedra.col(t) = tetrahedra_[static_cast<size_t>(t)];
      if (TetrahedronVolume(mesh, t) < 0) std::swap(mesh.tetrahedra(2, t), mesh.tetrahedra(3, t));
    }
    mesh.triangles = SurfaceOf(mesh.tetrahedra);
    return mesh;
  }

 private:
  static LatticeIndex Corner(const LatticeIndex& low, int corner) {
    return {low[0] + (corner & 1), low[1] + (corner >> 1 & 1), low[2] + (corner >> 2 & 1)};
  }
  int Vertex(const LatticeIndex& index) {
    return vertices_.emplace(index, static_cast<int>(vertices_.size())).first->second;
  }
  void Add(const std::array<int, 4>& corners) { tetrahedra_.emplace_back(corners.data()); }

  const Lattice lattice_;
  std::map<LatticeIndex, int> vertices_;
  std::vector<Eigen::Vector4i> tetrahedra_;
};

struct Face {
  std::array<int, 3> sorted;
  Eigen::Vector3i corners;
};

}  // namespace

Mesh FillCells(const Lattice& lattice, const std::function<bool(const Eigen::Vector3d& centre)>& keep) {
  LatticeMesher mesher(lattice);
  for (int z = 0; z < lattice.cells[2]; ++z) {
    for (int y = 0; y < lattice.cells[1]; ++y) {
      for (int x = 0; x < lattice.cells[0]; ++x) {
        const Eigen::Vector3d middle(x + 0.5, y + 0.5, z + 0.5);
        if (keep(lattice.origin + lattice.cell.cwiseProduct(middle))) mesher.AddCell({x, y, z});
      }
    }
  }
  return mesher.Finish();
}

Triangles SurfaceOf(const Tetrahedra& tetrahedra) {
  static constexpr int kFaces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  std::vector<Face> faces;
  for (Eigen::Index t = 0; t < tetrahedra.cols(); ++t) {
    for (const auto& face : kFaces) {
      const Eigen::Vector3i corners(tetrahedra(face[0], t), tetrahedra(face[1], t), tetrahedra(face[2], t));
      std::array<int, 3> sorted = {corners[0], corners[1], corners[2]};
      std::sort(sorted.begin(), sorted.end());
      faces.push_back({sorted, corners});
    }
  }
  std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) { return a.sorted < b.sorted; });
  std::vector<Eigen::Vector3i> outer;
  for (size_t i = 0; i < faces.size(); ++i) {
    const bool before = i > 0 && faces[i - 1].sorted == faces[i].sorted;
    const bool after = i + 1 < faces.size() && faces[i + 1].sorted == faces[i].sorted;
    if (!before && !after) outer.push_back(faces[i].corners);
  }
  Triangles triangles(3, static_cast<Eigen::Index>(outer.size()));
  for (size_t i = 0; i < outer.size(); ++i) triangles.col(static_cast<Eigen::Index>(i)) = outer[i];
  return triangles;
}

double TetrahedronVolume(const Mesh& mesh, Eigen::Index t) {
  const Eigen::Vector3d a = mesh.vertices.col(mesh.tetrahedra(0, t)), b = mesh.vertices.col(mesh.tetrahedra(1, t));
  const Eigen::Vector3d c = mesh.vertices.col(mesh.tetrahedra(2, t)), d = mesh.vertices.col(mesh.tetrahedra(3, t));
  return (b - a).dot((c - a).cross(d - a)) / 6;
}

double WindingNumber(const Mesh& surface, const Eigen::Vector3d& point) {
  double angle = 0;  // half the solid angle
  for (Eigen::Index t = 0; t < surface.triangles.cols(); ++t) {
    const Eigen::Vector3d a = surface.vertices.col(surface.triangles(0, t)) - point;
    const Eigen::Vector3d b = surface.vertices.col(surface.triangles(1, t)) - point;
    const Eigen::Vector3d c = surface.vertices.col(surface.triangles(2, t)) - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    angle += std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return angle / (2 * std::numbers::pi);
}

}  // namespace phrenic
