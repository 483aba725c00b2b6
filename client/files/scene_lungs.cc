#include "client/files/scene_lungs.h"

#include "server/schema/places.h"
#include "server/session/meshes.h"
#include "server/session/models.h"

namespace phrenic::client {

absl::StatusOr<fit::SceneLungs> ReadSceneLungs(const v1::SceneSource& source, const std::string& data_dir) {
  std::vector<std::string> folders = {Installed("scenes", PHRENIC_SCENES_DIR)};
  if (!data_dir.empty()) folders.push_back(data_dir + "/scenes");
  const session::Models models(session::SceneCatalogue(folders), data_dir, 1);
  const absl::StatusOr<v1::Scene> scene = models.Resolve(source);
  if (!scene.ok()) return scene.status();
  return fit::MakeSceneLungs(*scene,
                             session::MakeMeshSource(data_dir, {}, session::MeshCache(session::DefaultCacheFolder())));
}

}  // namespace phrenic::client
