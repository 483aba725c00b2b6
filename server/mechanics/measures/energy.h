// Energies [J]: the kinetic energy, sum of m v^2/2 over the vertices of deformable bodies including driven and fixed
// ones, and the elastic energy, the sum of Force::Energy over the forces that store energy by deformation.
#ifndef PHRENIC_SERVER_MECHANICS_MEASURES_ENERGY_H_
#define PHRENIC_SERVER_MECHANICS_MEASURES_ENERGY_H_

#include "server/mechanics/model_builder.h"

namespace phrenic {

// INVALID_ARGUMENT if a body is not deformable.
absl::StatusOr<std::unique_ptr<Measure>> MakeKineticEnergy(const v1::KineticEnergy& scene, const std::string& name,
                                                           std::string_view path, ModelBuilder& builder);
// Sums the named forces, which may be any conservative ones; if none is named, the conservative ones among springs,
// cables, elements, bending, cross-layer springs, attachments and target springs. INVALID_ARGUMENT if a named force
// does not exist, was left out by the compile step, or is not conservative.
absl::StatusOr<std::unique_ptr<Measure>> MakeElasticEnergy(const v1::ElasticEnergy& scene, const std::string& name,
                                                           std::string_view path, ModelBuilder& builder);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_MEASURES_ENERGY_H_
