#include "server/session/models.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <set>
#include <utility>

#include "absl/strings/str_cat.h"
#include "google/protobuf/io/coded_stream.h"
#include "google/protobuf/io/zero_copy_stream_impl_lite.h"
#include "server/imaging/surfaces/derived_bodies.h"
#include "server/mechanics/compile/shape_size.h"
#include "server/mechanics/parallel/compile_threads.h"
#include "server/mechanics/stop_check.h"
#include "server/schema/physique.h"
#include "server/schema/schema.h"
#include "server/session/mesh_cache/meshes_ahead.h"
#include "server/session/meshes.h"
#include "server/session/scene_hash.h"

namespace phrenic::session {
namespace {

std::string DeterministicBytes(const v1::Scene& scene) {
  std::string bytes;
  google::protobuf::io::StringOutputStream out(&bytes);
  google::protobuf::io::CodedOutputStream coded(&out);
  coded.SetSerializationDeterministic(true);
  scene.SerializeToCodedStream(&coded);
  coded.Trim();
  return bytes;
}

constexpr std::int64_t kSmallScene = 200'000;        // vertices and elements: compiles within a second
constexpr int kSmallAtATime = 3, kLargeAtATime = 2;  // the second takes some hundred megabytes at most
constexpr int kMostOthers = 64;                      // who wait for one compile
constexpr absl::Duration kAskAgain = absl::Milliseconds(50);

bool IsCancelled(const Requester& by) { return by.cancelled != nullptr && by.cancelled(); }

}  // namespace

Models::Models(SceneCatalogue catalogue, std::string data_dir, int capacity, Uploads* uploads, const Limits& limits,
               MeshCache cache)
    : catalogue_(std::move(catalogue)),
      data_dir_(std::move(data_dir)),
      uploads_(uploads),
      capacity_(static_cast<std::size_t>(std::max(1, capacity))),
      limits_(limits),
      cache_(std::move(cache)),
      slots_(kSmallAtATime, kLargeAtATime) {}

absl::StatusOr<Models::Surfaces> Models::HoldSurfaces(const v1::Scene& scene, const Requester& by) const {
  Surfaces surfaces;
  std::set<std::string> held;
  for (const v1::Body& body : scene.bodies()) {
    const v1::SurfaceFile* file = FileOf(body);
    if (uploads_ == nullptr || file == nullptr || !IsUpload(file->path()) || !held.insert(file->path()).second)
      continue;
    auto surface = uploads_->Hold(by, file->path());
    if (!surface.ok()) return surface.status();
    surfaces.push_back(*std::move(surface));
  }
  return surfaces;
}

absl::StatusOr<v1::Scene> Models::Resolve(const v1::SceneSource& source) const {
  v1::Scene scene;
  if (source.has_scene()) {
    scene = source.scene();
    if (absl::Status status = schema::Resolve(&scene); !status.ok()) return status;
  } else if (!source.name().empty()) {
    absl::StatusOr<v1::Scene> found = catalogue_.Find(source.name());
    if (!found.ok()) return found.status();
    scene = *std::move(found);
  } else {
    return absl::InvalidArgumentError("source: is empty; give the name of a scene, or a scene");
  }
  if (source.has_physique()) {
    if (absl::Status status = schema::ReplacePhysique(source.physique(), &scene); !status.ok()) return status;
  }
  if (source.has_resolution_mm()) {
    for (v1::Body& body : *scene.mutable_bodies()) {
      if (body.has_generated()) body.mutable_generated()->set_resolution_mm(source.resolution_mm());
    }
  }
  return scene;
}

absl::StatusOr<MeshSource> Models::MeshesOf(const v1::Scene& scene, const Requester& by) const {
  auto surfaces = HoldSurfaces(scene, by);
  if (!surfaces.ok()) return surfaces.status();
  const SizeLimits most = {limits_.vertices, limits_.elements};
  const auto size = EstimateSize(scene, MakeSizeSource(data_dir_, *surfaces), most);
  if (!size.ok()) return size.status();
  return MakeMeshSource(data_dir_, *std::move(surfaces), cache_);
}

// The scene, with the size and the modification time of each file that it names.
std::string Models::Key(const v1::Scene& scene) const {
  std::string key = DeterministicBytes(scene);
  for (const v1::Body& body : scene.bodies()) {
    const v1::SurfaceFile* file = FileOf(body);
    if (file == nullptr || IsUpload(file->path())) continue;
    const absl::StatusOr<std::string> path = ResolveBelow(data_dir_, file->path());
    if (!path.ok()) continue;
    std::error_code ignored;
    absl::StrAppend(&key, "|", std::filesystem::file_size(*path, ignored), "|",
                    std::filesystem::last_write_time(*path, ignored).time_since_epoch().count());
  }
  return key;
}

std::shared_ptr<const Model> Models::FindKept(const std::string& key) {
  const auto found =
      std::find_if(entries_.begin(), entries_.end(), [&key](const Entry& entry) { return entry.key == key; });
  if (found == entries_.end()) return nullptr;
  entries_.splice(entries_.begin(), entries_, found);
  return found->model;
}

// The latest model is kept however large it is.
void Models::Keep(Entry entry) {
  entries_.push_front(std::move(entry));
  std::int64_t elements = 0;
  std::size_t kept = 0;
  for (auto each = entries_.begin(); each != entries_.end();) {
    elements = SaturatingSum(elements, each->elements);
    const bool stays = kept == 0 || (kept < capacity_ && elements <= limits_.elements);
    ++kept;
    each = stays ? std::next(each) : entries_.erase(each);
  }
}

absl::StatusOr<std::shared_ptr<const Model>> Models::Await(Job& job, const Requester& by) {
  if (job.others >= kMostOthers) {
    return absl::ResourceExhaustedError(
        absl::StrCat(kMostOthers, " callers wait for this scene, and no more may: try again later"));
  }
  ++job.others;
  const auto done = [&job] { return job.result.has_value(); };
  bool left = false;
  while (!left && !mutex_.AwaitWithTimeout(absl::Condition(&done), kAskAgain)) left = IsCancelled(by);
  --job.others;
  if (left) return CallersGone();
  return *job.result;
}

absl::StatusOr<std::shared_ptr<const Model>> Models::CompileNow(const v1::Scene& scene, const Surfaces& surfaces,
                                                                const Requester& by, Job& job) {
  CompileOptions options;
  options.size_of = MakeSizeSource(data_dir_, surfaces);
  options.hash = &SceneHash;
  if (!by.trusted) options.limits = {limits_.vertices, limits_.elements};
  const auto size = EstimateSize(scene, options.size_of, options.limits);
  if (!size.ok()) return size.status();
  job.elements = size->elements;
  const MeshSource source = MeshesAhead(scene, MakeMeshSource(data_dir_, surfaces, cache_), CompileThreads());
  if (by.trusted) return phrenic::Compile(scene, imaging::WithDerived(source, scene), options);
  options.longest = limits_.compile_seconds;
  options.cancelled = [&by, &job] { return job.others == 0 && IsCancelled(by); };
  const bool small = size->vertices <= kSmallScene && size->elements <= kSmallScene;
  const auto lane = small ? CompileSlots::Lane::kSmall : CompileSlots::Lane::kLarge;
  const auto slot = slots_.Take(by.share, lane, options.cancelled);
  if (!slot.ok()) return slot.status();
  const StopCheck stop(options.cancelled, options.longest, "--max-compile-seconds");
  return phrenic::Compile(scene, imaging::WithDerived(source, scene, [&stop] { return stop.status(); }), options);
}

absl::StatusOr<std::shared_ptr<const Model>> Models::Find(const v1::Scene& scene, const Surfaces& surfaces,
                                                          const Requester& by) {
  const std::string key = Key(scene);
  const auto job = std::make_shared<Job>();
  {
    absl::MutexLock lock(&mutex_);
    for (auto kept = FindKept(key);; kept = FindKept(key)) {
      if (kept != nullptr) return kept;
      const auto [running, first] = jobs_.emplace(key, job);
      if (first) break;
      const std::shared_ptr<Job> other = running->second;
      auto model = Await(*other, by);
      // The other caller has gone: this one compiles.
      if (!absl::IsCancelled(model.status()) || IsCancelled(by)) return model;
    }
  }
  auto model = CompileNow(scene, surfaces, by, *job);
  absl::MutexLock lock(&mutex_);
  jobs_.erase(key);
  job->result = model;
  if (!model.ok()) return model;
  Keep({key, *model, job->elements});
  return model;
}

absl::StatusOr<Compiled> Models::Compile(const v1::SceneSource& source, const Requester& by) {
  const absl::StatusOr<v1::Scene> scene = Resolve(source);
  if (!scene.ok()) return scene.status();
  auto surfaces = HoldSurfaces(*scene, by);
  if (!surfaces.ok()) return surfaces.status();
  auto model = Find(*scene, *surfaces, by);
  if (!model.ok()) return model.status();
  return Compiled{*std::move(model), *std::move(surfaces)};
}

absl::StatusOr<std::shared_ptr<const Model>> Models::Get(const v1::SceneSource& source, const Requester& by) {
  auto compiled = Compile(source, by);
  if (!compiled.ok()) return compiled.status();
  return std::move(compiled->model);
}

absl::StatusOr<Compiled> Models::Restore(const v1::SavedScene& saved, const std::string& owner) {
  const Requester by{.owner = owner, .trusted = true};
  Surfaces surfaces;
  if (uploads_ != nullptr) {
    for (const v1::SavedSurface& surface : saved.surfaces()) {
      auto held = uploads_->Adopt(by, surface.name(), surface.content());
      if (!held.ok()) return held.status();
      surfaces.push_back(*std::move(held));
    }
  }
  const absl::StatusOr<v1::Scene> scene = Resolve(saved.source());
  if (!scene.ok()) return scene.status();
  auto model = Find(*scene, surfaces, by);
  if (!model.ok()) return model.status();
  return Compiled{*std::move(model), std::move(surfaces)};
}

}  // namespace phrenic::session
