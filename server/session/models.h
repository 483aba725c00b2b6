// Compiles scenes, some at a time, and keeps the models for the next session of the same scene.
#ifndef PHRENIC_SERVER_SESSION_MODELS_H_
#define PHRENIC_SERVER_SESSION_MODELS_H_

#include <atomic>
#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/status/statusor.h"
#include "absl/synchronization/mutex.h"
#include "phrenic/v1/saved.pb.h"
#include "phrenic/v1/session.pb.h"
#include "server/mechanics/compile/compile.h"
#include "server/session/compile_slots.h"
#include "server/session/mesh_cache/mesh_cache.h"
#include "server/session/requester.h"
#include "server/session/scene_catalogue.h"
#include "server/session/uploads.h"

namespace phrenic::session {

// A compiled scene, with the uploaded files that it uses.
struct Compiled {
  std::shared_ptr<const Model> model;
  std::vector<Uploads::Held> surfaces;  // kept on the disk as long as this exists
  bool same = true;                     // of a saved scene: the model has the same bits as the saved one
};

// Thread-safe. Compiles on the caller's thread; callers that want the same scene wait for one compile of it. The server
// owns one (service/server.cc). mutex_ guards what is kept and what is being compiled; it is not held during a compile.
// Scenes of at most 200,000 vertices and elements compile 3 at a time, larger ones 2 at a time.
class Models {
 public:
  // Keeps the `capacity` models that were used last, as long as they have limits.elements together. `uploads` outlives
  // it; null: scenes cannot name uploaded files. The latest model is kept in any case, and a `capacity` below 1 counts
  // as 1. Surface files lie below `data_dir`; empty: scenes read no files. Generated meshes are kept in `cache`.
  Models(SceneCatalogue catalogue, std::string data_dir, int capacity, Uploads* uploads = nullptr,
         const Limits& limits = {}, MeshCache cache = MeshCache());

  const SceneCatalogue& catalogue() const { return catalogue_; }
  // Returns the scene that `source` names or holds, at its resolution; INVALID_ARGUMENT "source: ..." if it is empty.
  // The resolution [mm] applies to generated bodies. The errors of schema::Resolve and SceneCatalogue::Find.
  absl::StatusOr<v1::Scene> Resolve(const v1::SceneSource& source) const;
  // Returns the source of a resolved scene's meshes, for what reads single bodies. Thread-safe; may outlive the call.
  // The errors of Uploads::Hold; RESOURCE_EXHAUSTED if the scene is larger than allowed.
  absl::StatusOr<MeshSource> MeshesOf(const v1::Scene& scene, const Requester& by) const;
  // Returns the compiled scene. The same scene gives the same model while its surface files are unchanged. The errors
  // of Uploads::Hold for the uploaded files that it names, of Compile, and of CompileSlots::Take. RESOURCE_EXHAUSTED if
  // the model is larger than allowed; CANCELLED once by.cancelled is true and no one else wants it. RESOURCE_EXHAUSTED
  // also if 64 callers wait for the scene, or if it takes more than limits.compile_seconds.
  absl::StatusOr<Compiled> Compile(const v1::SceneSource& source, const Requester& by) ABSL_LOCKS_EXCLUDED(mutex_);
  // The same without the files, for the server itself or without accounts.
  absl::StatusOr<std::shared_ptr<const Model>> Get(const v1::SceneSource& source, const Requester& by = {})
      ABSL_LOCKS_EXCLUDED(mutex_);
  // Uploads the files of a saved scene again, for their owner, and compiles it, however large it is. The errors of
  // Uploads::Adopt and Compile; the compile time is not limited, and no slot is taken. CompileSaved sets `same`.
  absl::StatusOr<Compiled> Restore(const v1::SavedScene& saved, const std::string& owner) ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  using Surfaces = std::vector<Uploads::Held>;
  struct Entry {
    std::string key;  // of Key
    std::shared_ptr<const Model> model;
    std::int64_t elements;  // an estimate (EstimateSize)
  };
  // A scene that is being compiled.
  struct Job {
    std::atomic<int> others = 0;  // who wait for it, besides the caller that compiles
    std::int64_t elements = 0;    // an estimate
    std::optional<absl::StatusOr<std::shared_ptr<const Model>>> result;
  };
  // Returns the scene's deterministic bytes with the size and the modification time of each file below data_dir.
  std::string Key(const v1::Scene& scene) const;
  // Returns the uploaded files that the scene names, each once. The errors of Uploads::Hold.
  absl::StatusOr<Surfaces> HoldSurfaces(const v1::Scene& scene, const Requester& by) const;
  // Returns a kept model, waits for another caller's compile, or compiles.
  absl::StatusOr<std::shared_ptr<const Model>> Find(const v1::Scene& scene, const Surfaces& surfaces,
                                                    const Requester& by) ABSL_LOCKS_EXCLUDED(mutex_);
  // Keeps the model, and drops those used least recently beyond the capacity or limits.elements.
  void Keep(Entry entry) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Null if none is kept; otherwise the model counts as used last.
  std::shared_ptr<const Model> FindKept(const std::string& key) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Waits for the result of another caller's compile. CANCELLED once by.cancelled is true. RESOURCE_EXHAUSTED if too
  // many wait. Looks at by.cancelled every 50 ms.
  absl::StatusOr<std::shared_ptr<const Model>> Await(Job& job, const Requester& by)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Takes a slot, unless the scene is trusted, and compiles; writes the size to `job`.
  absl::StatusOr<std::shared_ptr<const Model>> CompileNow(const v1::Scene& scene, const Surfaces& surfaces,
                                                          const Requester& by, Job& job) ABSL_LOCKS_EXCLUDED(mutex_);

  const SceneCatalogue catalogue_;
  const std::string data_dir_;  // empty: no files
  Uploads* const uploads_;      // null: no uploads
  const std::size_t capacity_;
  const Limits limits_;
  const MeshCache cache_;
  CompileSlots slots_;
  absl::Mutex mutex_;
  std::list<Entry> entries_ ABSL_GUARDED_BY(mutex_);                          // last used first
  std::map<std::string, std::shared_ptr<Job>> jobs_ ABSL_GUARDED_BY(mutex_);  // being compiled, by key
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_MODELS_H_
