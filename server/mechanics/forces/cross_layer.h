// Springs across a gap: between the two layers of a closed double layer, or between two bodies. The force law is in
// springs.h; the rest length is the distance of the two vertices in the rest meshes [m].
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_CROSS_LAYER_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_CROSS_LAYER_H_

#include "server/mechanics/model_builder.h"

namespace phrenic {

// Connects each selected vertex to its nearest opposite vertices within the distance: those of the other layer (the
// dot product of the normals is negative), or those of the other bodies. A pair gets one spring; coincident vertices
// get none. Returns null, and reports it, if there is no pair.
absl::StatusOr<std::unique_ptr<Force>> MakeCrossLayer(const v1::CrossLayer& scene, const std::string& name,
                                                      std::string_view path, ModelBuilder& builder);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_CROSS_LAYER_H_
