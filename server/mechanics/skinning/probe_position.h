// The position of a probe: a named vertex of a body whose motion frames and exports report.
#ifndef PHRENIC_SERVER_MECHANICS_SKINNING_PROBE_POSITION_H_
#define PHRENIC_SERVER_MECHANICS_SKINNING_PROBE_POSITION_H_

#include <Eigen/Core>

#include "server/mechanics/model.h"

namespace phrenic {

// Returns the probe's position [m] in `state`, whether its body is simulated, rigid (x = R X + t), skinned or fixed.
// Places all vertices of a skinned body (BodyPoints::Positions). Thread-safe, for threads with scratch memory of their
// own.
Eigen::Vector3d ProbePosition(const Model& model, const State& state, const Probe& probe, const Scratch& scratch = {});

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SKINNING_PROBE_POSITION_H_
