// Finite elements over the tetrahedra of bodies; the law is in corotated.h.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_SOLID_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_SOLID_H_

#include "server/mechanics/model_builder.h"

namespace phrenic {

// Null where no tetrahedron takes part; those without volume are left out.
absl::StatusOr<std::unique_ptr<Force>> MakeSolid(const v1::Solid& scene, const std::string& name, std::string_view path,
                                                 ModelBuilder& builder);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_SOLID_H_
