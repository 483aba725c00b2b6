// Springs across a gap: between the two layers of a closed double layer, or between two bodies. Their law is that of
// springs.h; the rest length is the gap as the meshes stand.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_CROSS_LAYER_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_CROSS_LAYER_H_

#include "server/mechanics/model_builder.h"

namespace phrenic {

// Null where no vertex has an opposite one. Each pair is joined once; vertices at the same place are not joined.
absl::StatusOr<std::unique_ptr<Force>> MakeCrossLayer(const v1::CrossLayer& scene, const std::string& name,
                                                      std::string_view path, ModelBuilder& builder);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_CROSS_LAYER_H_
