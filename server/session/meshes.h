// The sources of meshes for compiling a scene: generated parts, surface files below the data folder, and uploads.
#ifndef PHRENIC_SERVER_SESSION_MESHES_H_
#define PHRENIC_SERVER_SESSION_MESHES_H_

#include <string>

#include "absl/status/statusor.h"
#include "server/mechanics/compile/compile.h"
#include "server/session/uploads.h"

namespace phrenic::session {

// Returns the canonical path of the file `path` below `data_dir`. INVALID_ARGUMENT for an absolute path or one that
// leaves the folder (by ".." or a symbolic link), NOT_FOUND if there is no such file or no data folder.
absl::StatusOr<std::string> ResolveBelow(const std::string& data_dir, const std::string& path);

// Returns a thread-safe source, for which the path "upload:SHA256" names one of `uploads`. `uploads` outlives it; null:
// there are none.
MeshSource MakeMeshSource(std::string data_dir, Uploads* uploads = nullptr);

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_MESHES_H_
