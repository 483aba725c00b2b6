#include "server/mechanics/constraint_residual.h"

namespace phrenic {

ConstraintResidual LargestResidual(const Model& model, const State& state) {
  ConstraintResidual largest;
  for (const auto& constraint : model.constraints) {
    const double metres = constraint->Residual(state);
    if (metres > largest.metres) largest = {metres, constraint->name()};
  }
  return largest;
}

}  // namespace phrenic
