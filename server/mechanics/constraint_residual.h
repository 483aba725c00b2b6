// How well a state keeps the constraints of its model.
#ifndef PHRENIC_SERVER_MECHANICS_CONSTRAINT_RESIDUAL_H_
#define PHRENIC_SERVER_MECHANICS_CONSTRAINT_RESIDUAL_H_

#include <string_view>

#include "server/mechanics/model.h"

namespace phrenic {

struct ConstraintResidual {
  double metres = 0;            // the largest violation of any constraint [m]
  std::string_view constraint;  // whose it is; lives as long as the model; empty where nothing is violated
};

// Constraints that cannot all hold, or that are switched off, show here; others stay within 1e-9 of a link's length.
ConstraintResidual LargestResidual(const Model& model, const State& state);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_CONSTRAINT_RESIDUAL_H_
