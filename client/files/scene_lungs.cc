#include "client/files/scene_lungs.h"

#include "absl/strings/str_cat.h"
#include "server/mechanics/compile/shapes.h"
#include "server/mesh/topology.h"
#include "server/schema/places.h"
#include "server/session/meshes.h"
#include "server/session/models.h"

namespace phrenic::client {
namespace {

absl::StatusOr<v1::Body> FindLung(const v1::Scene& scene, v1::Side side) {
  for (const v1::Body& body : scene.bodies()) {
    if (body.anatomy().structure() == v1::STRUCTURE_LUNG && body.anatomy().side() == side) return body;
  }
  return absl::FailedPreconditionError(absl::StrCat("the scene \"", scene.name(), "\" has no ",
                                                    side == v1::SIDE_LEFT ? "left" : "right",
                                                    " lung: give a thorax, such as the scene thorax"));
}

absl::StatusOr<Mesh> ReadLung(const v1::Body& body, const MeshSource& source) {
  absl::StatusOr<Mesh> lung = MakeShape(body, source, {});
  if (!lung.ok() || AnalyseTopology(*lung).watertight()) return lung;
  return absl::FailedPreconditionError(
      absl::StrCat("the surface of the body \"", body.name(), "\" is not closed: see phrenic inspect"));
}

}  // namespace

absl::StatusOr<SceneLungs> ReadSceneLungs(const v1::SceneSource& source, const std::string& data_dir) {
  std::vector<std::string> folders = {Installed("scenes", PHRENIC_SCENES_DIR)};
  if (!data_dir.empty()) folders.push_back(data_dir + "/scenes");
  const session::Models models(session::SceneCatalogue(folders), data_dir, 1);
  const absl::StatusOr<v1::Scene> scene = models.Resolve(source);
  if (!scene.ok()) return scene.status();
  const MeshSource meshes = session::MakeMeshSource(data_dir, {}, session::MeshCache(session::DefaultCacheFolder()));
  const auto right_body = FindLung(*scene, v1::SIDE_RIGHT), left_body = FindLung(*scene, v1::SIDE_LEFT);
  if (!right_body.ok()) return right_body.status();
  if (!left_body.ok()) return left_body.status();
  absl::StatusOr<Mesh> right = ReadLung(*right_body, meshes), left = ReadLung(*left_body, meshes);
  if (!right.ok()) return right.status();
  if (!left.ok()) return left.status();
  return SceneLungs{{*right_body, *left_body},
                    {fit::LungTemplate(*std::move(right)), fit::LungTemplate(*std::move(left))}};
}

}  // namespace phrenic::client
