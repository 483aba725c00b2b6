#include "server/mechanics/damping.h"

namespace phrenic {

void SumDamping(const Model& model, const EvalContext& at, Eigen::VectorXd& c) {
  c.setZero();
  for (const auto& force : model.forces) force->AddDamping(at, c);
}

void SumSharedDamping(const Model& model, const EvalContext& at, OuterProducts& shared) {
  shared.Clear();
  for (const auto& force : model.forces) force->AddSharedDamping(at, shared);
  for (const auto& motion : model.motions) {
    if (motion->follows_coordinates()) shared.ForEach([&](Points& g) { motion->TransferForces(at, g); });
  }
}

}  // namespace phrenic
