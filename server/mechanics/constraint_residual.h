// How far a state violates the constraints of its model.
#ifndef PHRENIC_SERVER_MECHANICS_CONSTRAINT_RESIDUAL_H_
#define PHRENIC_SERVER_MECHANICS_CONSTRAINT_RESIDUAL_H_

#include <string>
#include <string_view>

#include "server/mechanics/model.h"

namespace phrenic {

// The largest violation of any constraint.
struct ConstraintResidual {
  double metres = 0;            // [m]
  std::string_view constraint;  // its name, valid as long as the model; empty if nothing is violated
};

// Returns the largest violation in a state. After a step it is below 1e-9 of a link's length, unless constraints
// contradict each other or are switched off. Thread-safe.
ConstraintResidual LargestResidual(const Model& model, const State& state);

// Returns what is wrong and the remedy if the violation is more than what the constraint's projection may leave
// (Constraint::tolerated); empty if it is not, or if the parameters switch the constraints off. For people: a warning
// of every output.
std::string ResidualWarning(const Model& model, const v1::Parameters& parameters, const ConstraintResidual& residual);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_CONSTRAINT_RESIDUAL_H_
