// The volume bounded by a surface [m^3], total or relative to rest, and its rate of change, the flow [m^3/s]. The
// equations are in breathing/chamber.h.
#ifndef PHRENIC_SERVER_MECHANICS_MEASURES_VOLUME_H_
#define PHRENIC_SERVER_MECHANICS_MEASURES_VOLUME_H_

#include "server/mechanics/model_builder.h"

namespace phrenic {

// Both return INVALID_ARGUMENT if the surface has no triangle or the plane's normal is zero.
absl::StatusOr<std::unique_ptr<Measure>> MakeVolume(const v1::Volume& scene, const std::string& name,
                                                    std::string_view path, ModelBuilder& builder);
absl::StatusOr<std::unique_ptr<Measure>> MakeFlow(const v1::Flow& scene, const std::string& name, std::string_view path,
                                                  ModelBuilder& builder);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_MEASURES_VOLUME_H_
