// Membranes: corotational finite elements in plane stress over the triangles of bodies. Equations: corotated.h.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_MEMBRANE_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_MEMBRANE_H_

#include "server/mechanics/model_builder.h"

namespace phrenic {

// Returns null, and reports it, if no triangle is selected. Degenerate triangles are left out.
absl::StatusOr<std::unique_ptr<Force>> MakeMembrane(const v1::Membrane& scene, const std::string& name,
                                                    std::string_view path, ModelBuilder& builder);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_MEMBRANE_H_
