// Makes the rides of bodies that are only seen: cartilages between ribs and sternum, lungs between ribs and diaphragm.
// Each vertex moves by its carriers' displacements, weighted by inverse distance at rest, or keeps its place in its
// nearest triangle (triangle_skin.h). Costs frames, not steps.
#ifndef PHRENIC_SERVER_MECHANICS_SKINNING_MAKE_SKINS_H_
#define PHRENIC_SERVER_MECHANICS_SKINNING_MAKE_SKINS_H_

#include "server/mechanics/model_builder.h"

namespace phrenic {

// Adds a Skin to the builder for each of the bodies. A carrier may ride itself when its ride was made before.
absl::Status AddSkins(const v1::Skin& scene, const std::string& name, std::string_view path, ModelBuilder& builder);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SKINNING_MAKE_SKINS_H_
