#include "server/session/meshes.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "server/anatomy/anatomy.h"
#include "server/meshio/meshio.h"

namespace phrenic::session {
namespace {

// Of the most verbose format (STL as text, two triangles of 250 bytes a vertex), so that no file that is within the
// limits is refused before it is read.
constexpr std::int64_t kFileBytesPerVertex = 500;
constexpr std::int64_t kDerivedVertices = 15'000;  // about those of an inner cage; a middle surface has fewer

// The size of a closed surface.
MeshSize Surface(std::int64_t vertices) { return {vertices, 3 * vertices, 2 * vertices, 0}; }

absl::StatusOr<Mesh> ReadUpload(const std::vector<Uploads::Held>& uploads, const v1::SurfaceFile& file) {
  for (const Uploads::Held& upload : uploads) {
    if (upload.file.path() != file.path()) continue;
    const auto bytes = upload.Bytes();
    return bytes.ok() ? meshio::Parse(upload.file.name, *bytes, file.unit()) : bytes.status();
  }
  return absl::NotFoundError(absl::StrCat(file.path().substr(0, 80), ": there is no such upload; upload it again"));
}

}  // namespace

absl::StatusOr<std::string> ResolveBelow(const std::string& data_dir, const std::string& path) {
  namespace fs = std::filesystem;
  if (data_dir.empty()) {
    return absl::NotFoundError(absl::StrCat(path, ": the server has no data folder; start it with --data DIR"));
  }
  std::error_code error;
  const fs::path root = fs::canonical(data_dir, error);
  if (error) return absl::NotFoundError(absl::StrCat("the data folder ", data_dir, " cannot be read"));
  const fs::path relative(path);
  const bool climbs = std::find(relative.begin(), relative.end(), "..") != relative.end();
  if (relative.is_absolute() || climbs) {
    return absl::InvalidArgumentError(
        absl::StrCat(path, ": paths are relative to the data folder and do not leave it"));
  }
  const fs::path resolved = fs::canonical(root / relative, error);
  if (error) return absl::NotFoundError(absl::StrCat(path, ": there is no such file below the data folder"));
  if (std::mismatch(root.begin(), root.end(), resolved.begin(), resolved.end()).first != root.end()) {
    return absl::InvalidArgumentError(absl::StrCat(path, ": a link leads out of the data folder"));
  }
  if (!fs::is_regular_file(resolved, error)) return absl::InvalidArgumentError(absl::StrCat(path, ": not a file"));
  return resolved.string();
}

bool IsUpload(const std::string& path) { return absl::StartsWith(path, std::string(Uploads::kPrefix)); }

const v1::SurfaceFile* FileOf(const v1::Body& body) {
  if (body.has_file()) return &body.file();
  if (body.has_derived() && body.derived().has_file()) return &body.derived().file();
  return body.has_filling() && body.filling().has_file() ? &body.filling().file() : nullptr;
}

MeshSource MakeMeshSource(std::string data_dir, std::vector<Uploads::Held> uploads, MeshCache cache) {
  return [data_dir = std::move(data_dir), uploads = std::move(uploads),
          cache = std::move(cache)](const v1::Body& body) -> absl::StatusOr<Mesh> {
    if (body.has_generated()) {
      return cache.Get(body.anatomy(), body.generated(),
                       [&body] { return anatomy::Generate(body.anatomy(), body.generated()); });
    }
    if (IsUpload(body.file().path())) return ReadUpload(uploads, body.file());
    const absl::StatusOr<std::string> path = ResolveBelow(data_dir, body.file().path());
    if (!path.ok()) return path.status();
    return meshio::ReadFile(*path, body.file().unit());
  };
}

SizeSource MakeSizeSource(std::string data_dir, const std::vector<Uploads::Held>& uploads) {
  std::map<std::string, std::int64_t> sizes;
  for (const Uploads::Held& upload : uploads) sizes[upload.file.path()] = upload.file.size;
  return [data_dir = std::move(data_dir), sizes = std::move(sizes)](const v1::Body& body) {
    if (body.has_generated()) {
      return Surface(
          anatomy::EstimateVertices(body.anatomy(), body.generated().resolution_mm(), body.generated().sheet()));
    }
    const v1::SurfaceFile* file = FileOf(body);
    if (file == nullptr) return body.has_derived() ? Surface(kDerivedVertices) : MeshSize{};
    if (const auto found = sizes.find(file->path()); found != sizes.end()) {
      return Surface(found->second / kFileBytesPerVertex);
    }
    std::error_code error;
    const absl::StatusOr<std::string> path = ResolveBelow(data_dir, file->path());
    const std::uintmax_t bytes = path.ok() ? std::filesystem::file_size(*path, error) : 0;
    return error ? MeshSize{} : Surface(static_cast<std::int64_t>(bytes) / kFileBytesPerVertex);
  };
}

}  // namespace phrenic::session
