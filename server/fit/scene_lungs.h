// The lungs of a scene, which a fit moves onto a person's.
#ifndef PHRENIC_SERVER_FIT_SCENE_LUNGS_H_
#define PHRENIC_SERVER_FIT_SCENE_LUNGS_H_

#include <array>

#include "absl/status/statusor.h"
#include "phrenic/v1/scene.pb.h"
#include "server/fit/person.h"
#include "server/mechanics/compile/mesh_source.h"
#include "server/mechanics/stop_check.h"

namespace phrenic::fit {

struct SceneLungs {
  std::array<v1::Body, 2> bodies;  // by Side
  LungTemplates templates;         // their surfaces
};

inline constexpr double kLargestLung = 0.6;  // extent along an axis [m]

// Returns the bodies with the anatomy of a right and a left lung. FAILED_PRECONDITION names the scene that lacks one,
// or the body whose surface is not closed or larger than kLargestLung; the errors of MakeShape. Thread-safe if `source`
// is.
absl::StatusOr<SceneLungs> MakeSceneLungs(const v1::Scene& scene, const MeshSource& source, const StopCheck& stop = {});

}  // namespace phrenic::fit

#endif  // PHRENIC_SERVER_FIT_SCENE_LUNGS_H_
