#include "server/session/carry_over.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/schema/schema.h"
#include "server/session/state_matching.h"

namespace phrenic::session {
namespace {

// Adds to the reason what the session needs.
absl::Status KeptAside(const store::SavedSession& saved, const std::string& scene, const absl::Status& why) {
  return absl::FailedPreconditionError(absl::StrCat(
      "session ", saved.id, ": the surface files of its scene \"", scene,
      "\", or the version of Phrenic, differ from those that it was made with, and its state cannot be matched (",
      std::string(why.message()),
      "): restore the files, or run the version that saved it, and restart the server; or delete the session"));
}

const v1::SavedMoment& LastOf(const store::SavedSession& saved) {
  return saved.later.empty() ? saved.moment : saved.later.back();
}

std::string Describe(const VertexMatch& match, const Model& model) {
  const auto vertices = model.rest.cols();
  if (match.bodies_by_distance == 0) return absl::StrCat(vertices, " vertices matched by index");
  return absl::StrFormat("%d vertices matched, those of %d bodies by the nearest rest positions, %.2g m away at most",
                         vertices, match.bodies_by_distance, match.largest_distance);
}

// Takes one step of a copy, which a state that does not fit the model would not survive.
absl::Status TryStep(const std::shared_ptr<const Model>& model, const v1::Parameters& parameters, const State& state) {
  Run run(model, parameters, state);
  return run.Step();
}

// Returns the session's saved state as a state of the model, with the parameters at that time.
absl::StatusOr<Fork> MatchedStart(const std::shared_ptr<const Model>& model, const store::SavedSession& saved,
                                  const VertexMatch& match) {
  auto state = MatchState(*model, saved.scene, saved.state, match);
  if (!state.ok()) return state.status();
  const v1::Session& status = saved.moment.session();
  if (absl::Status good = CheckState(*model, *state, status.constraint_residual()); !good.ok()) return good;
  Fork start{SavedParameters(*model, status.parameters()), *std::move(state), 0};
  if (absl::Status good = schema::Validate(start.parameters); !good.ok()) return good;
  if (status.has_divergence()) return start;
  if (absl::Status stepped = TryStep(model, start.parameters, start.state); !stepped.ok()) return stepped;
  return start;
}

// Sets what the session's status says of a state.
void SetTime(const State& state, v1::SavedMoment& moment) {
  moment.mutable_session()->set_tick(state.tick);
  moment.mutable_session()->set_time(state.time);
}

// Returns the last moment at `start`, whose journal this build cannot take.
Replayed WithoutJournal(Fork start, const store::SavedSession& saved, const std::string& how) {
  Replayed carried{std::move(start.state), LastOf(saved)};
  carried.carried_over = absl::StrCat(
      how, "; its last ", LastOf(saved).session().tick() - saved.moment.session().tick(),
      " steps could not be repeated in this build and are lost, its last parameters are kept; the run is a "
      "new one from tick ",
      carried.state.tick);
  SetTime(carried.state, carried.moment);
  carried.moment.clear_from_start();
  return carried;
}

}  // namespace

absl::StatusOr<Replayed> CarryOver(const std::shared_ptr<const Model>& model, const store::SavedSession& saved) {
  const std::string& scene = model->scene.name();
  const auto match = MatchVertices(*model, saved.scene, saved.state);
  if (!match.ok()) return KeptAside(saved, scene, match.status());
  auto start = MatchedStart(model, saved, *match);
  if (!start.ok()) return KeptAside(saved, scene, start.status());
  store::SavedSession matched = saved;
  MatchPulls(*model, saved.scene, *match, *matched.moment.mutable_session());
  for (v1::SavedMoment& moment : matched.later) MatchPulls(*model, saved.scene, *match, *moment.mutable_session());
  const std::string how = absl::StrCat(
      "the scene compiles to other bits than before, by another build of Phrenic or from changed surface files; the "
      "session continues from its saved state at tick ",
      start->state.tick, ", ", Describe(*match, *model));
  Run run(model, start->parameters, start->state);
  if (!ReplayJournal(matched.later, run).ok()) return WithoutJournal(*std::move(start), matched, how);
  Replayed carried{run.state(), LastOf(matched)};
  SetTime(carried.state, carried.moment);
  carried.carried_over = absl::StrCat(how, "; ", carried.state.tick - start->state.tick,
                                      " later steps were taken again by this build; the run is a new one from there");
  return carried;
}

}  // namespace phrenic::session
