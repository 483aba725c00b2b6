#include "server/fit/scene_lungs.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mechanics/compile/shapes.h"
#include "server/mesh/topology.h"

namespace phrenic::fit {
namespace {

absl::StatusOr<v1::Body> FindLung(const v1::Scene& scene, v1::Side side) {
  for (const v1::Body& body : scene.bodies()) {
    if (body.anatomy().structure() == v1::STRUCTURE_LUNG && body.anatomy().side() == side) return body;
  }
  return absl::FailedPreconditionError(absl::StrCat("the scene \"", scene.name(), "\" has no ",
                                                    side == v1::SIDE_LEFT ? "left" : "right",
                                                    " lung: give a thorax, such as the scene thorax"));
}

absl::StatusOr<Mesh> MakeLung(const v1::Body& body, const MeshSource& source, const StopCheck& stop) {
  absl::StatusOr<Mesh> lung = MakeShape(body, source, stop);
  if (!lung.ok()) return lung;
  const auto fault = [&body](const std::string& what) {
    return absl::FailedPreconditionError(absl::StrCat("the surface of the body \"", body.name(), "\" ", what));
  };
  if (!AnalyseTopology(*lung).watertight()) return fault("is not closed: see phrenic inspect");
  const double extent = (lung->vertices.rowwise().maxCoeff() - lung->vertices.rowwise().minCoeff()).maxCoeff();
  if (extent <= kLargestLung) return lung;
  return fault(absl::StrFormat("is %.3g m long, more than %g m: check its unit", extent, kLargestLung));
}

}  // namespace

absl::StatusOr<SceneLungs> MakeSceneLungs(const v1::Scene& scene, const MeshSource& source, const StopCheck& stop) {
  const auto right_body = FindLung(scene, v1::SIDE_RIGHT), left_body = FindLung(scene, v1::SIDE_LEFT);
  if (!right_body.ok()) return right_body.status();
  if (!left_body.ok()) return left_body.status();
  absl::StatusOr<Mesh> right = MakeLung(*right_body, source, stop);
  if (!right.ok()) return right.status();
  absl::StatusOr<Mesh> left = MakeLung(*left_body, source, stop);
  if (!left.ok()) return left.status();
  return SceneLungs{{*right_body, *left_body}, {LungTemplate(*std::move(right)), LungTemplate(*std::move(left))}};
}

}  // namespace phrenic::fit
