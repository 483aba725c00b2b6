#include "server/session/update_schedule.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "server/mechanics/compile/compile.h"
#include "server/mechanics/stability/largest_step.h"

namespace phrenic::session {

absl::Status UpdateSchedule::Add(std::int64_t tick, const v1::Parameters& changes) {
  if (waiting_.size() >= kMostWaiting) {
    return absl::ResourceExhaustedError(absl::StrCat("apply_at_tick: ", kMostWaiting,
                                                     " changes wait for their tick, the most that are allowed; wait "
                                                     "until some of them are applied"));
  }
  waiting_.emplace(tick, changes);
  return absl::OkStatus();
}

std::optional<v1::Parameters> UpdateSchedule::TakeDue(std::int64_t tick) {
  if (waiting_.empty() || waiting_.begin()->first > tick) return std::nullopt;
  return std::move(waiting_.extract(waiting_.begin()).mapped());
}

void UpdateSchedule::Save(v1::SavedMoment& moment) const {
  for (const auto& [tick, changes] : waiting_) {
    v1::SavedUpdate& update = *moment.add_waiting();
    update.set_at_tick(tick);
    *update.mutable_parameters() = changes;
  }
}

void UpdateSchedule::Restore(const v1::SavedMoment& moment) {
  for (const v1::SavedUpdate& update : moment.waiting()) waiting_.emplace(update.at_tick(), update.parameters());
}

double StableStepFor(const Model& model, const v1::Parameters& parameters, const v1::Parameters& known,
                     double known_step) {
  if (HaveSameStableStep(parameters, known)) return known_step;
  return LargestStableStep(model, parameters).seconds();
}

}  // namespace phrenic::session
