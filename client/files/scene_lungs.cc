#include "client/files/scene_lungs.h"

#include "absl/strings/str_cat.h"
#include "server/mesh/topology.h"
#include "server/schema/places.h"
#include "server/session/meshes.h"
#include "server/session/models.h"

namespace phrenic::client {
namespace {

absl::StatusOr<Mesh> ReadLung(const v1::Scene& scene, v1::Side side, const MeshSource& source) {
  const char* name = side == v1::SIDE_LEFT ? "left" : "right";
  for (const v1::Body& body : scene.bodies()) {
    if (body.anatomy().structure() != v1::STRUCTURE_LUNG || body.anatomy().side() != side) continue;
    absl::StatusOr<Mesh> lung = source(body);
    if (!lung.ok() || AnalyseTopology(*lung).watertight()) return lung;
    return absl::FailedPreconditionError(
        absl::StrCat("the surface of the body \"", body.name(), "\" is not closed: see phrenic inspect"));
  }
  return absl::FailedPreconditionError(
      absl::StrCat("the scene \"", scene.name(), "\" has no ", name, " lung: give a thorax, such as the scene thorax"));
}

}  // namespace

absl::StatusOr<fit::LungTemplates> ReadSceneLungs(const v1::SceneSource& source, const std::string& data_dir) {
  std::vector<std::string> folders = {Installed("scenes", PHRENIC_SCENES_DIR)};
  if (!data_dir.empty()) folders.push_back(data_dir + "/scenes");
  const session::Models models(session::SceneCatalogue(folders), data_dir, 1);
  const absl::StatusOr<v1::Scene> scene = models.Resolve(source);
  if (!scene.ok()) return scene.status();
  const MeshSource meshes = session::MakeMeshSource(data_dir, {}, session::MeshCache(session::DefaultCacheFolder()));
  absl::StatusOr<Mesh> right = ReadLung(*scene, v1::SIDE_RIGHT, meshes), left = right;
  if (!right.ok()) return right.status();
  left = ReadLung(*scene, v1::SIDE_LEFT, meshes);
  if (!left.ok()) return left.status();
  return fit::LungTemplates{fit::LungTemplate(*std::move(right)), fit::LungTemplate(*std::move(left))};
}

}  // namespace phrenic::client
