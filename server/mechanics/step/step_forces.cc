#include "server/mechanics/step/step_forces.h"

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "server/mechanics/step/load_batch.h"
#include "server/mechanics/step/spring_batch.h"

namespace phrenic {
namespace {

// A model's forces by how a step takes them.
struct Kinds {
  std::map<std::pair<Precision, bool>, std::vector<const Springs*>> springs;  // those that go into one batch
  std::vector<const Friction*> friction;
  std::vector<const SharedForce*> shared;
  std::vector<const Force*> others;
};

Kinds KindsOf(const Model& model) {
  Kinds kinds;
  for (const auto& force : model.forces) {
    if (const auto* const springs = dynamic_cast<const Springs*>(force.get())) {
      kinds.springs[{springs->precision(), springs->balanced()}].push_back(springs);
    } else if (const auto* const friction = dynamic_cast<const Friction*>(force.get())) {
      kinds.friction.push_back(friction);
    } else if (const auto* const shared = dynamic_cast<const SharedForce*>(force.get())) {
      kinds.shared.push_back(shared);
    } else {
      kinds.others.push_back(force.get());
    }
  }
  return kinds;
}

void Take(const Force& force, Model& model) {
  (force.by_range() ? model.range_forces : model.whole_forces).push_back(&force);
}

void TakeBatch(std::unique_ptr<Force> batch, Model& model) {
  Take(*batch, model);
  model.batches.push_back(std::move(batch));
}

}  // namespace

void ChooseStepForces(Model& model) {
  const Kinds kinds = KindsOf(model);
  for (const auto& [how, members] : kinds.springs) {
    auto batch = std::make_unique<SpringBatch>(members, model.rest);
    if (batch->packs() && model.packed_from < 0) model.packed_from = batch->rows().origin();
    TakeBatch(std::move(batch), model);
  }
  for (const Force* force : kinds.others) Take(*force, model);
  if (kinds.friction.empty() && kinds.shared.empty()) return;
  auto batch = std::make_unique<LoadBatch>(kinds.friction, kinds.shared);
  model.loads = batch.get();
  TakeBatch(std::move(batch), model);
}

}  // namespace phrenic
