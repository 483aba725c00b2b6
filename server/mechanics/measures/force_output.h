// Measures that read an output of a force (Force::outputs), such as pressure and volume of a Pressure, or flow and
// pressures of the Lungs.
#ifndef PHRENIC_SERVER_MECHANICS_MEASURES_FORCE_OUTPUT_H_
#define PHRENIC_SERVER_MECHANICS_MEASURES_FORCE_OUTPUT_H_

#include "server/mechanics/model_builder.h"

namespace phrenic {

// INVALID_ARGUMENT, with the valid names, if there is no such force or output.
absl::StatusOr<std::unique_ptr<Measure>> MakeForceOutput(const v1::ForceOutput& scene, const std::string& name,
                                                         std::string_view path, ModelBuilder& builder);

// Returns the force of that name. INVALID_ARGUMENT, with the names of the model's forces, if there is none.
absl::StatusOr<const Force*> FindForce(const std::string& name, std::string_view path, const ModelBuilder& builder);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_MEASURES_FORCE_OUTPUT_H_
