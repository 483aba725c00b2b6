// How large a scene's model will be, counted before any of it is built.
#ifndef PHRENIC_SERVER_MECHANICS_COMPILE_SCENE_SIZE_H_
#define PHRENIC_SERVER_MECHANICS_COMPILE_SCENE_SIZE_H_

#include <cstdint>
#include <limits>
#include <vector>

#include "absl/status/statusor.h"
#include "phrenic/v1/scene.pb.h"
#include "server/mechanics/compile/shape_size.h"
#include "server/mesh/mesh.h"

namespace phrenic {

struct SizeLimits {
  std::int64_t vertices = std::numeric_limits<std::int64_t>::max();
  // Springs, tetrahedra, triangles, pairs, weights and vertices that the scene's elements use, in all.
  std::int64_t elements = std::numeric_limits<std::int64_t>::max();
};

struct SceneSize {
  std::int64_t vertices = 0, elements = 0;
};

// Returns the size of a mesh that exists.
MeshSize SizeOf(const Mesh& mesh);

// Returns an upper bound of the size of a scene's model: shapes by their numbers, files and generated parts by
// `source` (null: zeros). RESOURCE_EXHAUSTED names the first body or element that exceeds a limit, and the setting;
// INVALID_ARGUMENT names a list of more than 10,000 entries, or a text of more than 4 KiB (a description: 64 KiB).
// The time is proportional to the scene's length. Thread-safe if `source` is.
absl::StatusOr<SceneSize> EstimateSize(const v1::Scene& scene, const SizeSource& source, const SizeLimits& limits);

// The same for the bodies that have been built. Requires: one size per body.
absl::StatusOr<SceneSize> CountSize(const v1::Scene& scene, const std::vector<MeshSize>& bodies,
                                    const SizeLimits& limits);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_COMPILE_SCENE_SIZE_H_
