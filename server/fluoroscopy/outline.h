// An outline of the trunk around its bones, in place of the skin that scenes lack.
#ifndef PHRENIC_SERVER_FLUOROSCOPY_OUTLINE_H_
#define PHRENIC_SERVER_FLUOROSCOPY_OUTLINE_H_

#include <vector>

#include "server/mesh/mesh.h"

namespace phrenic::fluoroscopy {

// Returns a closed surface [m] whose triangles face outwards: horizontal superellipses of the power 2.5, 20 mm apart
// from 100 mm below `low` to 60 mm above `high` (the heights of the bones at rest [m]), each around the box of the
// bones within 100 mm of its height, averaged with its three neighbours on either side, with 18 mm of tissue on all
// sides. Without arms, shoulder blades and breasts. `bones` are vertices [m]. Empty without bones. Deterministic.
Mesh TrunkOutline(const std::vector<Points>& bones, double low, double high);

}  // namespace phrenic::fluoroscopy

#endif  // PHRENIC_SERVER_FLUOROSCOPY_OUTLINE_H_
