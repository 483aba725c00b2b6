// Compiles scenes, and keeps the models for the next session of the same scene.
#ifndef PHRENIC_SERVER_SESSION_MODELS_H_
#define PHRENIC_SERVER_SESSION_MODELS_H_

#include <cstdint>
#include <list>
#include <memory>
#include <string>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/status/statusor.h"
#include "absl/synchronization/mutex.h"
#include "phrenic/v1/saved.pb.h"
#include "phrenic/v1/session.pb.h"
#include "server/mechanics/compile/compile.h"
#include "server/session/scene_catalogue.h"
#include "server/session/uploads.h"

namespace phrenic::session {

// Thread-safe. Compiles one scene at a time, which has all memory and cores for itself.
class Models {
 public:
  // Keeps the `capacity` models that were used last. `uploads` outlives it; null: scenes cannot name uploaded files.
  Models(SceneCatalogue catalogue, std::string data_dir, int capacity, Uploads* uploads = nullptr,
         std::int64_t most_vertices = Limits().vertices);

  const SceneCatalogue& catalogue() const { return catalogue_; }
  // Returns the scene that `source` names or holds, at its resolution; INVALID_ARGUMENT "source: ..." if it is empty.
  absl::StatusOr<v1::Scene> Resolve(const v1::SceneSource& source) const;
  // Returns the compiled scene. The same scene gives the same model while its surface files are unchanged.
  // RESOURCE_EXHAUSTED if the model has more vertices than allowed; the errors of Compile.
  absl::StatusOr<std::shared_ptr<const Model>> Get(const v1::SceneSource& source) ABSL_LOCKS_EXCLUDED(mutex_);
  // Returns the uploaded files that the scene names. The errors of Uploads::Hold.
  absl::StatusOr<std::vector<Uploads::Held>> HoldSurfaces(const v1::Scene& scene) const;
  // Uploads the files of a saved scene again, before it is compiled.
  absl::StatusOr<std::vector<Uploads::Held>> AdoptSurfaces(const v1::SavedScene& saved) const;

 private:
  struct Entry {
    std::string key;
    std::shared_ptr<const Model> model;
  };
  std::string Key(const v1::Scene& scene) const;
  // Check the number of vertices: of grids before they are generated, and of the compiled model.
  absl::Status CheckSize(const v1::Scene& scene) const;
  absl::Status CheckSize(const Model& model) const;

  const SceneCatalogue catalogue_;
  const std::string data_dir_;
  Uploads* const uploads_;
  const MeshSource meshes_;
  const std::size_t capacity_;
  const std::int64_t most_vertices_;
  absl::Mutex mutex_;
  std::list<Entry> entries_ ABSL_GUARDED_BY(mutex_);  // last used first
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_MODELS_H_
