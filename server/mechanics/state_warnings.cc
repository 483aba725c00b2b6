#include "server/mechanics/state_warnings.h"

#include <utility>

namespace phrenic {

std::vector<std::string> MotionWarnings(const Model& model, const State& state) {
  std::vector<std::string> warnings;
  for (const auto& motion : model.motions) {
    if (std::string warning = motion->Warning(state); !warning.empty()) warnings.push_back(std::move(warning));
  }
  return warnings;
}

std::vector<std::string> StateWarnings(const Model& model, const v1::Parameters& parameters, const State& state,
                                       const ConstraintResidual& residual) {
  std::vector<std::string> warnings = MotionWarnings(model, state);
  if (std::string warning = ResidualWarning(model, parameters, residual); !warning.empty()) {
    warnings.push_back(std::move(warning));
  }
  return warnings;
}

}  // namespace phrenic
