#include "server/session/mesh_cache/meshes_ahead.h"

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/strings/str_cat.h"
#include "absl/synchronization/mutex.h"
#include "server/anatomy/anatomy.h"
#include "server/jobs/thread_priority.h"

namespace phrenic::session {
namespace {

std::string PartKey(const v1::Body& body) {
  return absl::StrCat(body.anatomy().SerializeAsString(), "|", body.generated().SerializeAsString());
}

class Ahead {
 public:
  Ahead(const v1::Scene& scene, MeshSource source, int threads) : source_(std::move(source)), threads_(threads) {
    std::map<std::string, int> numbers;
    for (const v1::Body& body : scene.bodies()) {
      if (!body.has_generated()) continue;
      const auto [found, added] = numbers.emplace(PartKey(body), static_cast<int>(parts_.size()));
      if (added) parts_.push_back({.body = body, .mesh = std::nullopt});
      ++parts_[found->second].bodies;
    }
    numbers_ = std::move(numbers);
    for (int i = 0; i < static_cast<int>(parts_.size()); ++i) order_.push_back(i);
    const auto size = [this](int part) {
      const v1::Body& body = parts_[part].body;
      return anatomy::EstimateVertices(body.anatomy(), body.generated().resolution_mm(), body.generated().sheet());
    };
    std::stable_sort(order_.begin(), order_.end(), [&](int a, int b) { return size(a) > size(b); });
  }
  Ahead(const Ahead&) = delete;
  Ahead& operator=(const Ahead&) = delete;
  ~Ahead() {
    {
      absl::MutexLock lock(&mutex_);
      next_ = order_.size();
    }
    for (std::thread& worker : workers_) worker.join();
  }

  absl::StatusOr<Mesh> Get(const v1::Body& body) ABSL_LOCKS_EXCLUDED(mutex_) {
    if (!body.has_generated()) return source_(body);
    const auto found = numbers_.find(PartKey(body));
    if (found == numbers_.end()) return source_(body);
    Part& part = parts_[found->second];
    Start();
    absl::MutexLock lock(&mutex_);
    if (!part.taken) Make(part);
    while (!part.mesh.has_value() && MakeNext()) {
    }
    const auto made = [&part] { return part.mesh.has_value(); };
    mutex_.Await(absl::Condition(&made));
    // The mesh of the last body that asks for it is moved. A body that asks twice gets it from the source.
    if (part.bodies == 0) {
      mutex_.Unlock();
      absl::StatusOr<Mesh> mesh = source_(body);
      mutex_.Lock();
      return mesh;
    }
    return --part.bodies == 0 ? std::move(*part.mesh) : *part.mesh;
  }

 private:
  struct Part {
    v1::Body body;   // the first with it
    int bodies = 0;  // that have not asked for it
    bool taken = false;
    std::optional<absl::StatusOr<Mesh>> mesh;
  };

  // Starts the threads, at the first call.
  void Start() ABSL_LOCKS_EXCLUDED(mutex_) {
    absl::MutexLock lock(&mutex_);
    if (started_) return;
    started_ = true;
    const int most = std::min(threads_, static_cast<int>(parts_.size()));
    for (int i = 1; i < most; ++i) {
      try {
        workers_.emplace_back([this] {
          jobs::LowerThreadPriority();
          absl::MutexLock working(&mutex_);
          while (MakeNext()) {
          }
        });
      } catch (const std::system_error&) {  // the system has no more threads: those that run do the work
        break;
      }
    }
  }
  // Generates the next part that no thread has taken. Returns false if all are.
  bool MakeNext() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) {
    while (next_ < order_.size()) {
      Part& part = parts_[order_[next_++]];
      if (part.taken) continue;
      Make(part);
      return true;
    }
    return false;
  }
  // Generates a part, without the lock.
  void Make(Part& part) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) {
    part.taken = true;
    mutex_.Unlock();
    absl::StatusOr<Mesh> mesh = source_(part.body);
    mutex_.Lock();
    part.mesh = std::move(mesh);
  }

  const MeshSource source_;
  const int threads_;
  std::map<std::string, int> numbers_;  // of parts_, by PartKey; constant after construction
  std::vector<int> order_;              // of parts_, the largest first; constant after construction
  absl::Mutex mutex_;
  std::vector<Part> parts_;  // `body` is constant, the rest guarded by mutex_
  bool started_ ABSL_GUARDED_BY(mutex_) = false;
  std::size_t next_ ABSL_GUARDED_BY(mutex_) = 0;  // of order_
  std::vector<std::thread> workers_;
};

}  // namespace

MeshSource MeshesAhead(const v1::Scene& scene, MeshSource source, int threads) {
  return [ahead = std::make_shared<Ahead>(scene, std::move(source), threads)](const v1::Body& body) {
    return ahead->Get(body);
  };
}

}  // namespace phrenic::session
