// Scenes compiled, and kept for the next session of the same scene.
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

// Any thread may call; scenes are compiled one at a time, so that memory and cores are for one.
class Models {
 public:
  // Keeps the `capacity` models that were asked for last. `uploads` outlives it; null: scenes name none.
  Models(SceneCatalogue catalogue, std::string data_dir, int capacity, Uploads* uploads = nullptr,
         std::int64_t most_vertices = Limits().vertices);

  const SceneCatalogue& catalogue() const { return catalogue_; }
  // The scene that `source` names or holds, with its resolution; INVALID_ARGUMENT "source: ..." where it is empty.
  absl::StatusOr<v1::Scene> Resolve(const v1::SceneSource& source) const;
  // The same scene gives the same model as long as its surface files stay as they are. A model with no more
  // vertices in all than are allowed, else RESOURCE_EXHAUSTED.
  absl::StatusOr<std::shared_ptr<const Model>> Get(const v1::SceneSource& source) ABSL_LOCKS_EXCLUDED(mutex_);
  // The files that clients gave which the scene names; Uploads::Hold.
  absl::StatusOr<std::vector<Uploads::Held>> HoldSurfaces(const v1::Scene& scene) const;
  // Those of a scene that was saved, before it is compiled.
  absl::StatusOr<std::vector<Uploads::Held>> AdoptSurfaces(const v1::SavedScene& saved) const;

 private:
  struct Entry {
    std::string key;
    std::shared_ptr<const Model> model;
  };
  std::string Key(const v1::Scene& scene) const;
  // Refuses a scene whose shapes would not fit before they are made, and what was made of one.
  absl::Status CheckSize(const v1::Scene& scene) const;
  absl::Status CheckSize(const Model& model) const;

  const SceneCatalogue catalogue_;
  const std::string data_dir_;
  Uploads* const uploads_;
  const MeshSource meshes_;
  const std::size_t capacity_;
  const std::int64_t most_vertices_;
  absl::Mutex mutex_;
  std::list<Entry> entries_ ABSL_GUARDED_BY(mutex_);  // the last one asked for first
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_MODELS_H_
