#include "server/mechanics/step/force_schedule.h"

#include <map>
#include <utility>

#include "server/mechanics/step/spring_batch.h"

namespace phrenic {
namespace {

// The forces of a model by the way in which a step evaluates them.
struct Groups {
  std::map<std::pair<Precision, bool>, std::vector<const Springs*>>
      springs;  // by precision and balance: one batch each
  std::vector<const Friction*> friction;
  std::vector<const SharedForce*> shared;
  std::vector<const Force*> others;
};

Groups GroupForces(const Model& model) {
  Groups groups;
  for (const auto& force : model.forces) {
    if (const auto* const springs = dynamic_cast<const Springs*>(force.get())) {
      groups.springs[{springs->precision(), springs->balanced()}].push_back(springs);
    } else if (const auto* const friction = dynamic_cast<const Friction*>(force.get())) {
      groups.friction.push_back(friction);
    } else if (const auto* const shared = dynamic_cast<const SharedForce*>(force.get())) {
      groups.shared.push_back(shared);
    } else if (force->acts_on_vertices()) {
      groups.others.push_back(force.get());
    }
  }
  return groups;
}

void Append(const Force& force, ForceSchedule& schedule) {
  if (const auto* const by_block = dynamic_cast<const BlockForce*>(&force)) {
    schedule.by_block.push_back(by_block);
  } else {
    schedule.whole.push_back(&force);
  }
}

void AppendSprings(const std::vector<const Springs*>& members, const Points& rest, ForceSchedule& schedule) {
  SpringRows rows = MakeSpringRows(members, rest);
  const std::string name = JoinedName(members);
  if (!rows.InRanges()) {
    schedule.batches.push_back(std::make_unique<ReorderedSpringBatch>(name, std::move(rows)));
  } else {
    auto batch = std::make_unique<SpringBatch>(name, std::move(rows));
    if (batch->needs_packed() && schedule.packing_origin < 0) schedule.packing_origin = batch->rows().origin();
    schedule.batches.push_back(std::move(batch));
  }
  Append(*schedule.batches.back(), schedule);
}

}  // namespace

ForceSchedule ScheduleForces(const Model& model) {
  const Groups groups = GroupForces(model);
  ForceSchedule schedule;
  for (const auto& [how, members] : groups.springs) AppendSprings(members, model.rest, schedule);
  for (const Force* force : groups.others) Append(*force, schedule);
  if (groups.friction.empty() && groups.shared.empty()) return schedule;
  auto loads = std::make_unique<LoadBatch>(groups.friction, groups.shared);
  schedule.loads = loads.get();
  schedule.batches.push_back(std::move(loads));
  return schedule;
}

}  // namespace phrenic
