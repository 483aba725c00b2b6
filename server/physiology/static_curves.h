// The static pressure-volume curves of lungs and chest wall, for the Campbell diagram.
#ifndef PHRENIC_SERVER_PHYSIOLOGY_STATIC_CURVES_H_
#define PHRENIC_SERVER_PHYSIOLOGY_STATIC_CURVES_H_

#include <vector>

#include "phrenic/v1/references.pb.h"
#include "server/mechanics/model.h"

namespace phrenic::physiology {

// Returns the force of the scene that has lungs and abdomen; null for other scenes.
const v1::ThoraxPressures* ThoraxPressuresOf(const v1::Scene& scene);

// Returns the curves of lung recoil and of the relaxed chest wall, from a quarter of the rest volume to nearly full
// lungs. Empty for a scene without ThoraxPressures. Every field of `parameters` is set.
//   lungs: p = (p_0 - ln(r/(r - v))/e)/c, as forces/thorax_pressures.h;
//   chest wall: v = v_cage(p - p_0) + v_abdomen(p - p_0), cage and abdomen beside each other, of which each moves by
//   its own compliance: C_w c_w for the cage, less below rest (forces/chest_wall.h), and the abdomen's
//   p = v/(C c_a) (1 + (v/V)^2).
// Campbell (in: The Respiratory Muscles and the Mechanics of Breathing, 1958).
std::vector<v1::StaticCurve> StaticCurves(const v1::Scene& scene, const v1::Parameters& parameters);

}  // namespace phrenic::physiology

#endif  // PHRENIC_SERVER_PHYSIOLOGY_STATIC_CURVES_H_
