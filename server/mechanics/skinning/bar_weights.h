// Skin weights for a bar between two bones (SKIN_MODE_BAR).
#ifndef PHRENIC_SERVER_MECHANICS_SKINNING_BAR_WEIGHTS_H_
#define PHRENIC_SERVER_MECHANICS_SKINNING_BAR_WEIGHTS_H_

#include <vector>

#include "server/mechanics/skinning/skin_drivers.h"

namespace phrenic {

// Returns the weights of all vertices of a body at rest [m], in their order. The ends A and B are the vertices nearest
// to the first and to the second driver; a vertex x follows the first with 1 - t and the second with t,
//   t = (x - A).(B - A) / |B - A|^2, at most 1 and at least 0,
// so that drivers that are moved alike move the bar alike, and one that is moved alone turns it about its other end.
// Requires: two drivers, and a body with at least one vertex.
std::vector<SkinWeight> BarWeights(const SkinDrivers& drivers, const Points& bar);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SKINNING_BAR_WEIGHTS_H_
