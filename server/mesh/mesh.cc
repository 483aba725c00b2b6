#include "server/mesh/mesh.h"

#include "absl/strings/str_cat.h"

namespace phrenic {
namespace {

absl::Status OutOfRange(const std::string& what, int index, int vertices) {
  return absl::InvalidArgumentError(absl::StrCat(what, " names vertex ", index, " but the mesh has ", vertices,
                                                 " vertices (0 to ", vertices - 1, ")"));
}

template <typename Indices>
absl::Status CheckIndices(const Indices& indices, int vertices, const char* what) {
  for (Eigen::Index column = 0; column < indices.cols(); ++column) {
    for (Eigen::Index row = 0; row < indices.rows(); ++row) {
      const int index = indices(row, column);
      if (index >= 0 && index < vertices) continue;
      return OutOfRange(absl::StrCat(what, " ", column), index, vertices);
    }
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status Validate(const Mesh& mesh) {
  const int vertices = static_cast<int>(mesh.vertices.cols());
  if (vertices == 0) return absl::InvalidArgumentError("the mesh has no vertices");
  for (int i = 0; i < vertices; ++i) {
    if (!mesh.vertices.col(i).allFinite()) {
      return absl::InvalidArgumentError(absl::StrCat("vertex ", i, " has a coordinate that is not a finite number"));
    }
    if (const double largest = mesh.vertices.col(i).cwiseAbs().maxCoeff(); largest > kMaxNumber) {
      return absl::InvalidArgumentError(absl::StrCat("vertex ", i, " has a coordinate of ", largest, "; at most ",
                                                     kMaxNumber, " is accepted: is the file or its unit damaged?"));
    }
  }
  if (absl::Status status = CheckIndices(mesh.triangles, vertices, "triangle"); !status.ok()) return status;
  if (absl::Status status = CheckIndices(mesh.tetrahedra, vertices, "tetrahedron"); !status.ok()) return status;
  if (absl::Status status = CheckIndices(mesh.edges, vertices, "edge"); !status.ok()) return status;
  for (Eigen::Index e = 0; e < mesh.edges.cols(); ++e) {
    if (mesh.edges(0, e) != mesh.edges(1, e)) continue;
    return absl::InvalidArgumentError(
        absl::StrCat("edge ", e, " joins vertex ", mesh.edges(0, e), " with itself; remove it"));
  }
  for (const auto& [name, region] : mesh.regions) {
    for (const int index : region) {
      if (index >= 0 && index < vertices) continue;
      return OutOfRange(absl::StrCat("region \"", name, "\""), index, vertices);
    }
  }
  return absl::OkStatus();
}

}  // namespace phrenic
