// A scene's presets: values of live parameters that belong together.
#ifndef PHRENIC_SERVER_MECHANICS_COMPILE_PRESETS_H_
#define PHRENIC_SERVER_MECHANICS_COMPILE_PRESETS_H_

#include <string>

#include "absl/status/statusor.h"
#include "phrenic/v1/scene.pb.h"

namespace phrenic {

// Adds to each preset what others set and it does not, as the scene starts with it: whichever was chosen before, what a
// preset makes of a session is the same.
void CompletePresets(v1::Scene& scene);

// The parameters of one of the scene's presets, none where the name is empty. INVALID_ARGUMENT with the names there
// are.
absl::StatusOr<v1::Parameters> FindPreset(const v1::Scene& scene, const std::string& name);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_COMPILE_PRESETS_H_
