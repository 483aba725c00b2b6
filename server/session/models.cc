#include "server/session/models.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "google/protobuf/io/coded_stream.h"
#include "google/protobuf/io/zero_copy_stream_impl_lite.h"
#include "server/schema/schema.h"
#include "server/session/meshes.h"

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

absl::Status TooLarge(const std::string& what, std::int64_t vertices, std::int64_t most) {
  return absl::ResourceExhaustedError(
      absl::StrCat(what, " has ", vertices, " vertices, and no more than ", most, " are allowed (--max-vertices)"));
}

}  // namespace

Models::Models(SceneCatalogue catalogue, std::string data_dir, int capacity, Uploads* uploads,
               std::int64_t most_vertices)
    : catalogue_(std::move(catalogue)),
      data_dir_(data_dir),
      uploads_(uploads),
      meshes_(MakeMeshSource(std::move(data_dir), uploads)),
      capacity_(std::max(1, capacity)),
      most_vertices_(most_vertices) {}

absl::Status Models::CheckSize(const v1::Scene& scene) const {
  std::int64_t vertices = 0;
  for (int i = 0; i < scene.bodies_size(); ++i) {
    const v1::Body& body = scene.bodies(i);
    if (body.has_grid()) vertices += std::int64_t{body.grid().columns()} * body.grid().rows();
    if (vertices > most_vertices_) {
      return TooLarge(absl::StrCat("bodies[", i, "].grid: with it the scene"), vertices, most_vertices_);
    }
  }
  return absl::OkStatus();
}

absl::Status Models::CheckSize(const Model& model) const {
  std::int64_t vertices = 0;
  for (const BodyModel& body : model.bodies) vertices += body.mesh.vertices.cols();
  if (vertices <= most_vertices_) return absl::OkStatus();
  return TooLarge("bodies: the scene", vertices, most_vertices_);
}

absl::StatusOr<std::vector<Uploads::Held>> Models::HoldSurfaces(const v1::Scene& scene) const {
  std::vector<Uploads::Held> surfaces;
  for (const v1::Body& body : scene.bodies()) {
    if (uploads_ == nullptr || !absl::StartsWith(body.file().path(), std::string(Uploads::kPrefix))) continue;
    auto held = uploads_->Hold(body.file().path());
    if (!held.ok()) return held.status();
    surfaces.push_back(*std::move(held));
  }
  return surfaces;
}

absl::StatusOr<std::vector<Uploads::Held>> Models::AdoptSurfaces(const v1::SavedScene& saved) const {
  std::vector<Uploads::Held> surfaces;
  if (uploads_ == nullptr) return surfaces;
  for (const v1::SavedSurface& surface : saved.surfaces()) {
    auto held = uploads_->Adopt(surface.name(), surface.content());
    if (!held.ok()) return held.status();
    surfaces.push_back(*std::move(held));
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
  if (source.has_resolution_mm()) {
    for (v1::Body& body : *scene.mutable_bodies()) {
      if (body.has_generated()) body.mutable_generated()->set_resolution_mm(source.resolution_mm());
    }
  }
  return scene;
}

// The scene, with the size and the modification time of each file that it names.
std::string Models::Key(const v1::Scene& scene) const {
  std::string key = DeterministicBytes(scene);
  for (const v1::Body& body : scene.bodies()) {
    if (!body.has_file()) continue;
    const absl::StatusOr<std::string> path = ResolveBelow(data_dir_, body.file().path());
    if (!path.ok()) continue;
    std::error_code ignored;
    absl::StrAppend(&key, "|", std::filesystem::file_size(*path, ignored), "|",
                    std::filesystem::last_write_time(*path, ignored).time_since_epoch().count());
  }
  return key;
}

absl::StatusOr<std::shared_ptr<const Model>> Models::Get(const v1::SceneSource& source) {
  const absl::StatusOr<v1::Scene> scene = Resolve(source);
  if (!scene.ok()) return scene.status();
  if (absl::Status status = CheckSize(*scene); !status.ok()) return status;
  std::string key = Key(*scene);
  absl::MutexLock lock(&mutex_);
  const auto found =
      std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) { return entry.key == key; });
  if (found != entries_.end()) {
    entries_.splice(entries_.begin(), entries_, found);
    return entries_.front().model;
  }
  absl::StatusOr<std::shared_ptr<const Model>> model = Compile(*scene, meshes_);
  if (!model.ok()) return model.status();
  if (absl::Status status = CheckSize(**model); !status.ok()) return status;
  entries_.push_front({std::move(key), *model});
  if (entries_.size() > capacity_) entries_.pop_back();
  return model;
}

}  // namespace phrenic::session
