#include "server/mechanics/damping.h"

namespace phrenic {

void SumDamping(const Model& model, const EvalContext& at, Eigen::VectorXd& c) {
  c.setZero();
  for (const auto& force : model.forces) force->AddDamping(at, c);
}

void SumSharedDamping(const Model& model, const EvalContext& at, OuterProducts& shared) {
  shared.Clear();
  for (const auto& force : model.forces) force->AddSharedDamping(at, shared);
}

}  // namespace phrenic
