// Mesh: a triangle surface, a tetrahedral solid, or a network of edges. Coordinates are in metres in the patient frame
// LPS (+x left, +y posterior, +z superior).
#ifndef PHRENIC_SERVER_MESH_MESH_H_
#define PHRENIC_SERVER_MESH_MESH_H_

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "absl/status/status.h"

namespace phrenic {

using Points = Eigen::Matrix3Xd;      // 3 x n, one column per vertex
using Triangles = Eigen::Matrix3Xi;   // 3 x n, vertex indices, counter-clockwise seen from outside
using Tetrahedra = Eigen::Matrix4Xi;  // 4 x n, vertex indices a b c d with det(b - a, c - a, d - a) > 0
using Edges = Eigen::Matrix2Xi;       // 2 x n, vertex indices
using ConstPoints = Eigen::Ref<const Points>;
using MutablePoints = Eigen::Ref<Points>;

inline constexpr double kMaxNumber = 1e9;      // of a coordinate in any unit; squares and products stay accurate
inline constexpr double kMaxCoordinate = 1e6;  // [m]; of what is simulated or measured

struct Mesh {
  Points vertices;                                  // [m]
  Triangles triangles;                              // the surface; for a solid, its boundary faces
  Tetrahedra tetrahedra;                            // empty unless the mesh is a solid
  Edges edges;                                      // empty if the edges are those of the triangles
  std::map<std::string, std::vector<int>> regions;  // named vertex sets: "tendon", "muscle", "rim", "crus-right"
};

// Checks that the mesh has a vertex, that every coordinate is a number up to kMaxNumber, every index is in range, and
// every edge has two ends. INVALID_ARGUMENT names the first vertex, triangle, tetrahedron, edge or region that fails.
absl::Status Validate(const Mesh& mesh);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MESH_MESH_H_
