// Compiles a Scene into a Model that contains only the elements the scene needs, with a report of what runs, what was
// left out and why.
#ifndef PHRENIC_SERVER_MECHANICS_COMPILE_COMPILE_H_
#define PHRENIC_SERVER_MECHANICS_COMPILE_COMPILE_H_

#include <functional>
#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "server/mechanics/compile/mesh_source.h"
#include "server/mechanics/compile/scene_size.h"
#include "server/mechanics/model.h"

namespace phrenic {

// What a compile may cost, by default anything, and how the report identifies the scene.
struct CompileOptions {
  SizeLimits limits = {};                     // checked before anything is built, and again with the meshes of files
  SizeSource size_of = nullptr;               // of files and generated parts
  std::function<bool()> cancelled = nullptr;  // true once the callers have gone; null: never
  double longest = 0;                         // [s]; 0: any time
  // The report's scene_hash, of a model with bodies and elements (session/scene_hash.h); null: none.
  std::function<std::string(const Model& model)> hash = nullptr;
};

// Thread-safe if `source` is. Errors of `source` are passed on; INVALID_ARGUMENT names the field:
// "forces[2].springs.bodies[0]: there is no body or layer \"lnug\"; there are ...". The errors of EstimateSize;
// CANCELLED once options.cancelled is true, RESOURCE_EXHAUSTED after options.longest: between two stages, and within
// loops over pairs of vertices.
absl::StatusOr<std::shared_ptr<const Model>> Compile(const v1::Scene& scene, const MeshSource& source,
                                                     const CompileOptions& options = {});

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_COMPILE_COMPILE_H_
