// Solids: corotational finite elements over the tetrahedra of bodies. Equations: corotated.h.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_SOLID_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_SOLID_H_

#include "server/mechanics/model_builder.h"

namespace phrenic {

// Returns null, and reports it, if no tetrahedron is selected. Degenerate tetrahedra are left out.
absl::StatusOr<std::unique_ptr<Force>> MakeSolid(const v1::Solid& scene, const std::string& name, std::string_view path,
                                                 ModelBuilder& builder);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_SOLID_H_
