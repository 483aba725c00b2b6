// Presets of a scene: named sets of live parameters.
#ifndef PHRENIC_SERVER_MECHANICS_COMPILE_PRESETS_H_
#define PHRENIC_SERVER_MECHANICS_COMPILE_PRESETS_H_

#include <string>

#include "absl/status/statusor.h"
#include "phrenic/v1/scene.pb.h"

namespace phrenic {

// Completes each preset with the scene's initial values of the parameters that only other presets set. The result of
// choosing a preset then does not depend on the preset chosen before.
void CompletePresets(v1::Scene& scene);

// Returns the parameters of the preset of that name; an empty message if the name is empty. INVALID_ARGUMENT, with the
// scene's preset names, if there is none.
absl::StatusOr<v1::Parameters> FindPreset(const v1::Scene& scene, const std::string& name);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_COMPILE_PRESETS_H_
