// Makes the skins of bodies that are only seen (thesis section 6.1.3), such as cartilages between ribs and sternum, and
// lungs between ribs and diaphragm. Each vertex gets weights by inverse distance at rest (inverse_distance_weights.h)
// or without jumps (smooth_weights.h) or along a bar (bar_weights.h), or a binding to its nearest triangle
// (triangle_skin.h) or to a sheet (sheet_skin.h). Skins are evaluated per frame, not per step.
#ifndef PHRENIC_SERVER_MECHANICS_SKINNING_ADD_SKINS_H_
#define PHRENIC_SERVER_MECHANICS_SKINNING_ADD_SKINS_H_

#include "server/mechanics/model_builder.h"

namespace phrenic {

// Adds a Skin to the builder for each body of the message. A driver may be skinned itself, if its skin was added
// before. INVALID_ARGUMENT if a body does not exist, is not only seen, or has a skin already, or if a bar has not two
// drivers.
absl::Status AddSkins(const v1::Skin& scene, const std::string& name, std::string_view path, ModelBuilder& builder);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SKINNING_ADD_SKINS_H_
