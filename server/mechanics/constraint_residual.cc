#include "server/mechanics/constraint_residual.h"

#include "absl/strings/str_format.h"

namespace phrenic {
namespace {

// Returns the violation [m] that the projection of the constraint of this name may leave.
double ToleratedBy(const Model& model, std::string_view constraint) {
  for (const auto& each : model.constraints) {
    if (each->name() == constraint) return each->tolerated(model.size);
  }
  return 0;
}

}  // namespace

ConstraintResidual LargestResidual(const Model& model, const State& state) {
  ConstraintResidual largest;
  for (const auto& constraint : model.constraints) {
    const double metres = constraint->Residual(state);
    if (metres > largest.metres) largest = {metres, constraint->name()};
  }
  return largest;
}

std::string ResidualWarning(const Model& model, const v1::Parameters& parameters, const ConstraintResidual& residual) {
  if (!parameters.apply_links() || residual.metres <= ToleratedBy(model, residual.constraint)) return "";
  return absl::StrFormat(
      "%s does not hold, it is off by %.4g mm: take out links that contradict each other, move less, or use "
      "PROJECTION_EXACT or more sweeps",
      std::string(residual.constraint), 1e3 * residual.metres);
}

}  // namespace phrenic
