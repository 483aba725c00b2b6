#include "server/mechanics/masses.h"

#include "absl/strings/str_cat.h"
#include "server/mechanics/draft.h"
#include "server/mesh/normals.h"

namespace phrenic {
namespace {

constexpr double kLeastShare = 0.5;  // of an equal one

}  // namespace

absl::StatusOr<Eigen::VectorXd> VertexMasses(const v1::Body& body, const Mesh& mesh, std::string_view path) {
  const Eigen::Index n = mesh.vertices.cols();
  Eigen::VectorXd share = VertexAreas(mesh.vertices, mesh.triangles);
  const double area = share.sum();
  if (area <= 0 && body.has_substance()) {
    return FieldError(absl::StrCat(std::string(path), ".substance"), "the body has no area: give it a mass instead");
  }
  const double total =
      body.has_substance() ? body.substance().density() * body.substance().thickness() * area : body.mass();
  if (area <= 0) return Eigen::VectorXd::Constant(n, total / static_cast<double>(n));
  share = share.cwiseMax(kLeastShare * area / static_cast<double>(n));
  return share * (total / share.sum());
}

}  // namespace phrenic
