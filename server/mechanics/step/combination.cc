#include "server/mechanics/step/combination.h"

#include <cmath>

#include "absl/strings/str_cat.h"

namespace phrenic {
namespace {

bool IsImplicit(const Integrator& integrator) { return std::isinf(integrator.MaxStep({.omega_max = 1})); }

// True if it is no equation even while nothing moves: it can be projected after a step only.
bool IsProjectedOnly(const Constraint& constraint, const Model& model) {
  return !constraint.smooth() && !constraint.SameMotion(model.rest, model.rest);
}

}  // namespace

absl::Status CheckCombination(const Model& model, const Integrator& integrator, const v1::Parameters& parameters) {
  if (model.constraints.empty() || !parameters.apply_links() || !IsImplicit(integrator)) return absl::OkStatus();
  for (const auto& constraint : model.constraints) {
    if (!IsProjectedOnly(*constraint, model)) continue;
    return absl::FailedPreconditionError(absl::StrCat(
        std::string(integrator.name()), " gains energy with ", constraint->name(),
        ", whose PROJECTION_THESIS moves positions after a step: set projection: PROJECTION_EXACT, or an explicit "
        "integrator such as semi_implicit_euler"));
  }
  return absl::OkStatus();
}

}  // namespace phrenic
