// What a force says about itself beside its pull: a pressure's pressure and volume, the lungs' flow and pressures.
#ifndef PHRENIC_SERVER_MECHANICS_MEASURES_FORCE_OUTPUT_H_
#define PHRENIC_SERVER_MECHANICS_MEASURES_FORCE_OUTPUT_H_

#include "server/mechanics/model_builder.h"

namespace phrenic {

absl::StatusOr<std::unique_ptr<Measure>> MakeForceOutput(const v1::ForceOutput& scene, const std::string& name,
                                                         std::string_view path, ModelBuilder& builder);

// The force of that name; INVALID_ARGUMENT with the names of those that run.
absl::StatusOr<const Force*> FindForce(const std::string& name, std::string_view path, const ModelBuilder& builder);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_MEASURES_FORCE_OUTPUT_H_
