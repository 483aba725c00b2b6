// Rows of the acceptance table that a graph over time can show.
#ifndef PHRENIC_SERVER_PHYSIOLOGY_HEALTH_RANGES_H_
#define PHRENIC_SERVER_PHYSIOLOGY_HEALTH_RANGES_H_

#include <vector>

#include "phrenic/v1/references.pb.h"
#include "server/mechanics/model.h"

namespace phrenic::physiology {

// Returns the ranges of RowsOfHealth that say how far a measure of the scene moves, in SI units. Empty for a scene
// without the force ThoraxPressures, whose breath the table is about.
std::vector<v1::HealthRange> HealthRanges(const v1::Scene& scene);

}  // namespace phrenic::physiology

#endif  // PHRENIC_SERVER_PHYSIOLOGY_HEALTH_RANGES_H_
