// Where the compile step gets its meshes: the generated thorax, surface files below the data folder, and uploads.
#ifndef PHRENIC_SERVER_SESSION_MESHES_H_
#define PHRENIC_SERVER_SESSION_MESHES_H_

#include <string>

#include "absl/status/statusor.h"
#include "server/mechanics/compile/compile.h"
#include "server/session/uploads.h"

namespace phrenic::session {

// The place of `path` below `data_dir`, both made canonical. INVALID_ARGUMENT for an absolute path or one that leaves
// the folder (by ".." or a symbolic link), NOT_FOUND where there is no such file or no data folder.
absl::StatusOr<std::string> ResolveBelow(const std::string& data_dir, const std::string& path);

// Any thread may call it. "upload:SHA256" is one of `uploads`, which outlives the source; null: there are none.
MeshSource MakeMeshSource(std::string data_dir, Uploads* uploads = nullptr);

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_MESHES_H_
