// Generated meshes, kept in a folder: a thorax takes seconds to generate and a hundredth of that to read.
#ifndef PHRENIC_SERVER_SESSION_MESH_CACHE_MESH_CACHE_H_
#define PHRENIC_SERVER_SESSION_MESH_CACHE_MESH_CACHE_H_

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "phrenic/v1/scene.pb.h"
#include "server/mesh/mesh.h"

namespace phrenic::session {

// Returns PHRENIC_CACHE, else systemd's CACHE_DIRECTORY, else "phrenic" in XDG_CACHE_HOME or ~/.cache; "none" if none
// of these variables is set.
std::string DefaultCacheFolder();

// A folder of files, one per mesh, named by a hash of the part, its resolution, the code that generates it (kMeshCode),
// the layout of the file and the processor: other versions generate other bits, and so do the libraries' functions on
// another processor. All programs of a build share the files. Damaged ones are generated again. A folder that cannot be
// written to disables the cache without an error. Thread-safe, also across processes, as files are complete before they
// get their name.
class MeshCache {
 public:
  static constexpr std::int64_t kMostBytes = 256 << 20;

  // `folder` empty or "none": keeps nothing. It is created when the first mesh is kept, readable by its owner alone.
  // Above `most_bytes` in all, the files that were used first are deleted.
  explicit MeshCache(std::string folder = "", std::int64_t most_bytes = kMostBytes);

  // Returns the kept mesh of a generated part, with the bits that `generate` gives, or the result of `generate`, which
  // it keeps if it is a mesh.
  absl::StatusOr<Mesh> Get(const v1::Anatomy& part, const v1::Generated& shape,
                           absl::FunctionRef<absl::StatusOr<Mesh>()> generate) const;

 private:
  void Keep(const std::string& file, std::string_view bytes) const;

  std::string folder_;  // empty: keeps nothing
  std::int64_t most_bytes_;
};

// The contents of a file: the arrays of a mesh, in the byte order of the machine, and their SHA-256.
std::string PackMesh(const Mesh& mesh);
// Returns the mesh with the same bits; nullopt if the bytes are not those of PackMesh.
std::optional<Mesh> UnpackMesh(std::string_view bytes);

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_MESH_CACHE_MESH_CACHE_H_
