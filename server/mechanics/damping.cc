#include "server/mechanics/damping.h"

#include <algorithm>

namespace phrenic {
namespace {

// Passes blocks on, scaled.
class ScaledBlocks final : public StiffnessSink {
 public:
  ScaledBlocks(double scale, StiffnessSink& sink) : scale_(scale), sink_(sink) {}
  void Add(int i, int j, const Eigen::Matrix3d& block) override { sink_.Add(i, j, scale_ * block); }
  void AddOuter(double scale, const Points& g) override { sink_.AddOuter(scale_ * scale, g); }

 private:
  const double scale_;
  StiffnessSink& sink_;
};

}  // namespace

void SumDamping(const Model& model, const EvalContext& at, Eigen::VectorXd& c) {
  c.setZero();
  for (const auto& force : model.forces) force->AddDamping(at, c);
}

void SumSharedDamping(const Model& model, const EvalContext& at, OuterProducts& shared) {
  shared.Clear();
  for (const auto& force : model.forces) force->AddSharedDamping(at, shared);
  for (const auto& motion : model.motions) {
    if (motion->follows_coordinates()) shared.Change([&](Points& g) { motion->TransferForces(at, g); });
  }
}

bool HasViscosity(const Model& model) {
  return std::any_of(model.forces.begin(), model.forces.end(),
                     [](const auto& force) { return force->has_viscosity(); });
}

void AddViscosity(const Force& force, const EvalContext& at, double weight, StiffnessSink& sink) {
  if (!force.has_viscosity()) return;
  ScaledBlocks scaled(weight, sink);
  force.AddViscosity(at, scaled);
}

}  // namespace phrenic
