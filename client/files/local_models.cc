#include "client/files/local_models.h"

#include <vector>

#include "client/terminal/progress.h"
#include "server/schema/places.h"

namespace phrenic::client {

session::Models LocalModels(const std::string& data_dir) {
  std::vector<std::string> folders = {Installed("scenes", PHRENIC_SCENES_DIR)};
  if (!data_dir.empty()) folders.push_back(data_dir + "/scenes");
  session::Limits limits;
  limits.compile_seconds = 0;  // the user can interrupt it
  return session::Models(session::SceneCatalogue(folders), data_dir, 1, nullptr, limits,
                         session::MeshCache(session::DefaultCacheFolder()));
}

absl::StatusOr<std::shared_ptr<const Model>> CompileLocally(const Context& context, const v1::SceneSource& source,
                                                            const std::string& name, const std::string& data_dir) {
  session::Models models = LocalModels(data_dir);
  const Progress compiling("compiling " + name);
  return models.Get(source, {.cancelled = [&context] { return context.interruption->happened(); }});
}

}  // namespace phrenic::client
