#include "client/files/scene_lungs.h"

#include "client/files/local_models.h"
#include "server/session/meshes.h"

namespace phrenic::client {

absl::StatusOr<fit::SceneLungs> ReadSceneLungs(const v1::SceneSource& source, const std::string& data_dir) {
  const absl::StatusOr<v1::Scene> scene = LocalModels(data_dir).Resolve(source);
  if (!scene.ok()) return scene.status();
  return fit::MakeSceneLungs(*scene,
                             session::MakeMeshSource(data_dir, {}, session::MeshCache(session::DefaultCacheFolder())));
}

}  // namespace phrenic::client
