#include "server/mechanics/constraint_residual.h"

#include "absl/strings/str_format.h"

namespace phrenic {
namespace {

constexpr double kTolerated = 1e-6;  // of the scene's size

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
  if (!parameters.apply_links() || residual.metres <= kTolerated * model.size) return "";
  return absl::StrFormat(
      "%s does not hold, it is off by %.4g mm: take out links that contradict each other, move less, or use "
      "PROJECTION_EXACT",
      std::string(residual.constraint), 1e3 * residual.metres);
}

}  // namespace phrenic
