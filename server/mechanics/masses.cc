#include "server/mechanics/masses.h"

#include "absl/strings/str_cat.h"
#include "server/mechanics/draft.h"
#include "server/mesh/normals.h"
#include "server/mesh/tetrahedra.h"

namespace phrenic {
namespace {

constexpr double kLeastShare = 0.5;  // of an equal one

// A quarter of the volume of the tetrahedra around each vertex [m^3]; a third of the area of the triangles [m^2] of a
// surface.
Eigen::VectorXd Shares(const Mesh& mesh) {
  if (mesh.tetrahedra.cols() == 0) return VertexAreas(mesh.vertices, mesh.triangles);
  Eigen::VectorXd share = Eigen::VectorXd::Zero(mesh.vertices.cols());
  for (Eigen::Index t = 0; t < mesh.tetrahedra.cols(); ++t) {
    for (int k = 0; k < 4; ++k) share[mesh.tetrahedra(k, t)] += TetrahedronVolume(mesh, t) / 4;
  }
  return share;
}

}  // namespace

absl::StatusOr<Eigen::VectorXd> VertexMasses(const v1::Body& body, const Mesh& mesh, std::string_view path) {
  const Eigen::Index n = mesh.vertices.cols();
  Eigen::VectorXd share = Shares(mesh);
  const double sum = share.sum();
  if (sum <= 0 && body.has_substance()) {
    return FieldError(absl::StrCat(std::string(path), ".substance"),
                      "the body has neither area nor volume: give it a mass instead");
  }
  const double thickness = mesh.tetrahedra.cols() == 0 ? body.substance().thickness() : 1;
  const double total = body.has_substance() ? body.substance().density() * thickness * sum : body.mass();
  if (sum <= 0) return Eigen::VectorXd::Constant(n, total / static_cast<double>(n));
  share = share.cwiseMax(kLeastShare * sum / static_cast<double>(n));
  return share * (total / share.sum());
}

}  // namespace phrenic
