// Energies [J]: sum of m v^2/2 over deformable bodies, driven and fixed vertices included, and the sum of forces' own
// energies (force.h).
#ifndef PHRENIC_SERVER_MECHANICS_MEASURES_ENERGY_H_
#define PHRENIC_SERVER_MECHANICS_MEASURES_ENERGY_H_

#include "server/mechanics/model_builder.h"

namespace phrenic {

absl::StatusOr<std::unique_ptr<Measure>> MakeKineticEnergy(const v1::KineticEnergy& scene, const std::string& name,
                                                           std::string_view path, ModelBuilder& builder);
// A force that is named must be there and have an energy. A force that the compile step left out has none.
absl::StatusOr<std::unique_ptr<Measure>> MakeElasticEnergy(const v1::ElasticEnergy& scene, const std::string& name,
                                                           std::string_view path, ModelBuilder& builder);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_MEASURES_ENERGY_H_
