#include "server/mesh/ellipsoid.h"

#include <array>

namespace phrenic {
namespace {

using LatticeIndex = std::array<int, 3>;  // a lattice point of the octahedron |x| + |y| + |z| = divisions

class Octasphere {
 public:
  explicit Octasphere(int divisions) : divisions_(divisions) {}

  // Adds the octahedron's face in the octant with these signs (+1 or -1 per axis), facing outwards.
  void AddFace(const LatticeIndex& sign) {
    const bool mirrored = sign[0] * sign[1] * sign[2] < 0;
    for (int a = 0; a < divisions_; ++a) {
      for (int b = 0; a + b < divisions_; ++b) {
        const int c = divisions_ - a - b;
        const auto at = [&](int i, int j) {
          return Vertex({sign[0] * i, sign[1] * j, sign[2] * (divisions_ - i - j)});
        };
        AddTriangle({at(a, b), at(a + 1, b), at(a, b + 1)}, mirrored);
        if (c > 1) AddTriangle({at(a + 1, b), at(a + 1, b + 1), at(a, b + 1)}, mirrored);
      }
    }
  }

  // Returns the mesh with every vertex projected onto the ellipsoid.
  Mesh ToMesh(const Eigen::Vector3d& centre, const Eigen::Vector3d& radii) const {
    Mesh mesh;
    mesh.vertices.resize(3, static_cast<Eigen::Index>(vertices_.size()));
    for (const auto& [index, i] : vertices_) {
      const Eigen::Vector3d direction = Eigen::Vector3d(index[0], index[1], index[2]).normalized();
      mesh.vertices.col(i) = centre + radii.cwiseProduct(direction);
    }
    mesh.triangles.resize(3, static_cast<Eigen::Index>(triangles_.size()));
    for (size_t t = 0; t < triangles_.size(); ++t) mesh.triangles.col(static_cast<Eigen::Index>(t)) = triangles_[t];
    return mesh;
  }

  std::vector<int> Equator() const {
    std::vector<int> equator;
    for (const auto& [index, i] : vertices_) {
      if (index[2] == 0) equator.push_back(i);
    }
    return equator;
  }

 private:
  // Returns the vertex at a lattice point, which neighbouring faces share.
  int Vertex(const LatticeIndex& index) {
    return vertices_.emplace(index, static_cast<int>(vertices_.size())).first->second;
  }
  void AddTriangle(const Eigen::Vector3i& corners, bool mirrored) {
    triangles_.emplace_back(mirrored ? Eigen::Vector3i(corners[0], corners[2], corners[1]) : corners);
  }

  const int divisions_;
  std::map<LatticeIndex, int> vertices_;
  std::vector<Eigen::Vector3i> triangles_;
};

}  // namespace

Mesh EllipsoidSurface(const Eigen::Vector3d& centre, const Eigen::Vector3d& radii, int divisions, bool upper_half) {
  Octasphere sphere(divisions);
  for (const int z : {1, -1}) {
    if (z < 0 && upper_half) continue;
    for (const int y : {1, -1}) {
      for (const int x : {1, -1}) sphere.AddFace({x, y, z});
    }
  }
  Mesh mesh = sphere.ToMesh(centre, radii);
  if (upper_half) mesh.regions.emplace("rim", sphere.Equator());
  return mesh;
}

}  // namespace phrenic
