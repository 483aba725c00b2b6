// Which bodies show the tissue of a scene. Thread-safe.
#ifndef PHRENIC_SERVER_MECHANICS_SKINNING_TISSUE_BODIES_H_
#define PHRENIC_SERVER_MECHANICS_SKINNING_TISSUE_BODIES_H_

#include <vector>

#include "server/mechanics/model.h"

namespace phrenic {

// True if the body is deformable or follows a deformable one.
bool FollowsTissue(const Model& model, const BodyModel& body);

// Returns the deformable bodies, ascending. In place of the middle surface of a sheet stand the seen bodies that follow
// it by SKIN_MODE_SHEET: people look at, export and measure these.
std::vector<int> TissueBodies(const Model& model);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SKINNING_TISSUE_BODIES_H_
