// Changes of a session's parameters, at once or bound to a tick.
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mechanics/compile/compile.h"
#include "server/mechanics/stability/largest_step.h"
#include "server/session/session.h"

namespace phrenic::session {
namespace {

std::vector<std::string> Warnings(const v1::Parameters& parameters, double stable_step) {
  if (parameters.time_step() <= stable_step) return {};
  return {
      absl::StrFormat("time_step: %.3g s is above %.3g s, the largest stable step at the present stiffness, and "
                      "the session will probably diverge; set it to %.2g s or less",
                      parameters.time_step(), stable_step, 0.9 * stable_step)};
}

// That of `known`, which has `known_step`, where nothing that it depends on is another.
double StableStepOf(const Model& model, const v1::Parameters& parameters, const v1::Parameters& known,
                    double known_step) {
  if (parameters.elasticity() == known.elasticity() && parameters.integrator() == known.integrator()) return known_step;
  return LargestStableStep(model, parameters).seconds();
}

}  // namespace

absl::Status Session::CheckRevision(std::optional<std::int64_t> expected) const {
  if (!expected.has_value() || *expected == revision_) return absl::OkStatus();
  return absl::AbortedError(absl::StrCat("expected_revision: ", *expected, " is stale, the session is at revision ",
                                         revision_, "; read it again and repeat the change"));
}

absl::StatusOr<Session::Updated> Session::Update(const v1::Parameters& changes,
                                                 std::optional<std::int64_t> expected_revision,
                                                 std::optional<std::int64_t> at_tick, std::string_view token) {
  absl::MutexLock one_at_a_time(&update_mutex_);
  const v1::Session before = status();
  v1::Parameters parameters = before.parameters();
  parameters.MergeFrom(changes);
  // Not on the stepping thread: it takes a while.
  const double stable_step = StableStepOf(*model_, parameters, before.parameters(), before.largest_stable_step());
  auto updated = AskAs(token, [&] {
    absl::Status good = CheckRevision(expected_revision);
    return good.ok() ? UpdateAt(changes, stable_step, at_tick) : good;
  });
  if (!updated.ok()) return updated;
  auto saved = Saved();
  if (!saved.ok()) return saved.status();
  return Updated{*std::move(saved), Warnings(parameters, stable_step)};
}

absl::Status Session::UpdateAt(const v1::Parameters& changes, double stable_step, std::optional<std::int64_t> at_tick) {
  const std::int64_t tick = run_.state().tick;
  if (at_tick.value_or(tick) < tick) {
    return absl::FailedPreconditionError(absl::StrCat("apply_at_tick: ", *at_tick, " is past, the session is at tick ",
                                                      tick, "; name a later tick, or reset the session first"));
  }
  if (at_tick.value_or(tick) == tick) {
    Merge(changes, stable_step);
    return absl::OkStatus();
  }
  if (waiting_updates_.size() >= kMostWaiting) {
    return absl::ResourceExhaustedError(absl::StrCat("apply_at_tick: ", kMostWaiting,
                                                     " changes wait for their tick, and no more may; let some of "
                                                     "them come first"));
  }
  waiting_updates_.emplace(*at_tick, changes);
  Changed();
  return absl::OkStatus();
}

void Session::Merge(const v1::Parameters& changes, double stable_step) {
  v1::Parameters parameters = run_.parameters();
  parameters.MergeFrom(changes);
  run_.set_parameters(parameters);
  stable_step_ = stable_step;
  Changed();
}

// The largest stable step was worked out for nobody yet: who asked did not know what would change before this tick.
void Session::ApplyDueUpdates() {
  while (!waiting_updates_.empty() && waiting_updates_.begin()->first <= run_.state().tick) {
    const v1::Parameters changes = std::move(waiting_updates_.extract(waiting_updates_.begin()).mapped());
    v1::Parameters parameters = run_.parameters();
    parameters.MergeFrom(changes);
    Merge(changes, StableStepOf(*model_, parameters, run_.parameters(), stable_step_));
  }
}

}  // namespace phrenic::session
