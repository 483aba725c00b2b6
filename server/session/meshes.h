// The sources of meshes for compiling a scene: generated parts, surface files below the data folder, and uploads.
#ifndef PHRENIC_SERVER_SESSION_MESHES_H_
#define PHRENIC_SERVER_SESSION_MESHES_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "server/mechanics/compile/compile.h"
#include "server/session/mesh_cache/mesh_cache.h"
#include "server/session/uploads.h"

namespace phrenic::session {

// Returns the canonical path of the file `path` below `data_dir`. INVALID_ARGUMENT for an absolute path or one that
// leaves the folder (by ".." or a symbolic link), NOT_FOUND if there is no such file or no data folder.
// INVALID_ARGUMENT also for a folder. Thread-safe; the file may change afterwards.
absl::StatusOr<std::string> ResolveBelow(const std::string& data_dir, const std::string& path);

// Returns the surface file of a body, also of one that fills it or is derived from it; null if the body has none. It
// belongs to `body`.
const v1::SurfaceFile* FileOf(const v1::Body& body);
// True for a path "upload:SHA256".
bool IsUpload(const std::string& path);

// Returns a thread-safe source, for which the path "upload:SHA256" names one of `uploads`. NOT_FOUND if none of them
// has that hash. Meshes are in metres. It holds `uploads` as long as it exists, and returns the errors of ResolveBelow,
// meshio and anatomy::Generate. Generated parts are kept in `cache`.
MeshSource MakeMeshSource(std::string data_dir, std::vector<Uploads::Held> uploads = {}, MeshCache cache = MeshCache());

// Returns the sizes of generated parts by their resolution, roughly, and an estimate for files by their
// length. A file counts as one vertex per 500 bytes, those of the most verbose format, so that no file within the
// limits is refused unread. A file that is missing counts as empty.
SizeSource MakeSizeSource(std::string data_dir, const std::vector<Uploads::Held>& uploads = {});

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_MESHES_H_
