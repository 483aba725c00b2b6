// The sources of meshes for compiling a scene: generated parts, surface files below the data folder, and uploads.
#ifndef PHRENIC_SERVER_SESSION_MESHES_H_
#define PHRENIC_SERVER_SESSION_MESHES_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "server/mechanics/compile/compile.h"
#include "server/session/uploads.h"

namespace phrenic::session {

// Returns the canonical path of the file `path` below `data_dir`. INVALID_ARGUMENT for an absolute path or one that
// leaves the folder (by ".." or a symbolic link), NOT_FOUND if there is no such file or no data folder.
absl::StatusOr<std::string> ResolveBelow(const std::string& data_dir, const std::string& path);

// Returns the surface file of a body, also of one that fills it; null if the body has none.
const v1::SurfaceFile* FileOf(const v1::Body& body);
// True for a path "upload:SHA256".
bool IsUpload(const std::string& path);

// Returns a thread-safe source, for which the path "upload:SHA256" names one of `uploads`. NOT_FOUND if none of them
// has that hash.
MeshSource MakeMeshSource(std::string data_dir, std::vector<Uploads::Held> uploads = {});

// Returns the sizes of generated parts by their resolution, roughly, and an estimate for files by their
// length.
SizeSource MakeSizeSource(std::string data_dir, const std::vector<Uploads::Held>& uploads = {});

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_MESHES_H_
