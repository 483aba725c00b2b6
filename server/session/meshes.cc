#include "server/session/meshes.h"

#include <algorithm>
#include <filesystem>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "server/anatomy/anatomy.h"
#include "server/meshio/meshio.h"

namespace phrenic::session {

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

MeshSource MakeMeshSource(std::string data_dir, Uploads* uploads) {
  return [data_dir = std::move(data_dir), uploads](const v1::Body& body) -> absl::StatusOr<Mesh> {
    if (body.has_generated())
      return anatomy::Generate(body.anatomy(), body.generated().resolution_mm(), body.generated().sheet());
    if (uploads != nullptr && absl::StartsWith(body.file().path(), std::string(Uploads::kPrefix))) {
      return uploads->Read(body.file().path(), body.file().unit());
    }
    const absl::StatusOr<std::string> path = ResolveBelow(data_dir, body.file().path());
    if (!path.ok()) return path.status();
    return meshio::ReadFile(*path, body.file().unit());
  };
}

}  // namespace phrenic::session
