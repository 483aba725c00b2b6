// The cavity of the thorax between its wall and the diaphragm.
#ifndef PHRENIC_SERVER_PHYSIOLOGY_CAVITY_H_
#define PHRENIC_SERVER_PHYSIOLOGY_CAVITY_H_

#include "server/physiology/parts.h"

namespace phrenic::physiology {

// Returns how much the volume inside the closed surface grows from one moment to another [m^3]: cones from a fixed
// point over the part of the wall that lies above the diaphragm's border at rest, over the wall's flat top, and over
// the simulated muscle. kNone without a wall, or if the muscle is a closed sheet.
double CavityGrowth(const Model& model, const Parts& parts, const State& from, const State& to);

}  // namespace phrenic::physiology

#endif  // PHRENIC_SERVER_PHYSIOLOGY_CAVITY_H_
