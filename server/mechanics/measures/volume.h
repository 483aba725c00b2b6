// The volume that a surface bounds [m^3], the whole or what it has swept since rest, and its rate [m^3/s]: chamber.h.
#ifndef PHRENIC_SERVER_MECHANICS_MEASURES_VOLUME_H_
#define PHRENIC_SERVER_MECHANICS_MEASURES_VOLUME_H_

#include "server/mechanics/model_builder.h"

namespace phrenic {

absl::StatusOr<std::unique_ptr<Measure>> MakeVolume(const v1::Volume& scene, const std::string& name,
                                                    std::string_view path, ModelBuilder& builder);
absl::StatusOr<std::unique_ptr<Measure>> MakeFlow(const v1::Flow& scene, const std::string& name, std::string_view path,
                                                  ModelBuilder& builder);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_MEASURES_VOLUME_H_
