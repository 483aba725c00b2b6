// The expiratory muscles of abdomen and ribs, which one drive activates.
#ifndef PHRENIC_SERVER_MECHANICS_BREATHING_EXPIRATORY_MUSCLES_H_
#define PHRENIC_SERVER_MECHANICS_BREATHING_EXPIRATORY_MUSCLES_H_

#include "server/mechanics/eval_context.h"

namespace phrenic {

inline constexpr double kExpiratoryTime = 0.1;  // with which the activation follows its drive [s]

// Returns what the activation tends to.
inline double ExpiratoryDrive(const EvalContext& at) {
  return at.parameters.apply_muscles() ? at.parameters.expiratory_activation() * at.expiration : 0;
}

// Returns the rate of an activation [1/s].
inline double ExpiratoryRate(const EvalContext& at, double activation) {
  return (ExpiratoryDrive(at) - activation) / kExpiratoryTime;
}

// Returns an activation after a step of `dt` [s] that ends at `end`, by the implicit Euler method.
inline double AdvanceExpiratory(const EvalContext& end, double dt, double activation) {
  return activation + dt / (kExpiratoryTime + dt) * (ExpiratoryDrive(end) - activation);
}

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_BREATHING_EXPIRATORY_MUSCLES_H_
