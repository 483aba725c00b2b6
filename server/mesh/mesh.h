// A triangle surface, a solid of tetrahedra, or a network of edges, in metres and the patient frame (LPS: +x left, +y
// posterior, +z superior).
#ifndef PHRENIC_SERVER_MESH_MESH_H_
#define PHRENIC_SERVER_MESH_MESH_H_

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "absl/status/status.h"

namespace phrenic {

using Points = Eigen::Matrix3Xd;      // 3 x n, one column per vertex
using Triangles = Eigen::Matrix3Xi;   // 3 x n, vertex indices, anticlockwise seen from outside
using Tetrahedra = Eigen::Matrix4Xi;  // 4 x n, vertex indices, det(b - a, c - a, d - a) > 0
using Edges = Eigen::Matrix2Xi;       // 2 x n, vertex indices
using ConstPoints = Eigen::Ref<const Points>;
using MutablePoints = Eigen::Ref<Points>;

struct Mesh {
  Points vertices;  // [m]
  Triangles triangles;
  Tetrahedra tetrahedra;                            // of a solid; its surface is in triangles
  Edges edges;                                      // only where they are not the triangles' own edges
  std::map<std::string, std::vector<int>> regions;  // named vertex sets: "tendon", "muscle", "rim", "crus-right"
};

// Checks that there is at least one vertex, that every coordinate is finite and every index is in range; the error
// names the first offender and its remedy.
absl::Status Validate(const Mesh& mesh);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MESH_MESH_H_
