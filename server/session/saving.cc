#include "server/session/saving.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "google/protobuf/util/time_util.h"
#include "server/mechanics/pulls.h"
#include "server/session/run.h"
#include "server/store/saved_state.h"

namespace phrenic::session {
namespace {

using google::protobuf::util::TimeUtil;
using Person = ControlState::Person;

void SavePerson(const Person& person, v1::SavedPerson& saved) {
  saved.set_name(person.name);
  saved.set_token(person.token);
  saved.set_time_to_live_ms(absl::ToInt64Milliseconds(person.time_to_live));
  saved.set_asks(person.asks);
  if (person.expires == absl::InfinitePast()) return;
  *saved.mutable_expires() = TimeUtil::NanosecondsToTimestamp(absl::ToUnixNanos(person.expires));
}

Person RestorePerson(const v1::SavedPerson& saved) {
  Person person;
  person.name = saved.name();
  person.token = saved.token();
  person.time_to_live = absl::Milliseconds(saved.time_to_live_ms());
  person.asks = saved.asks();
  if (saved.has_expires()) {
    person.expires = absl::FromUnixNanos(TimeUtil::TimestampToNanoseconds(saved.expires()));
  }
  return person;
}

void SaveLink(const ControlState::Link& link, v1::SavedLink& saved) {
  saved.set_id(link.id);
  saved.set_secret_sha256(link.secret_sha256);
  saved.set_role(link.role);
  saved.set_made_by(link.made_by);
  *saved.mutable_expires() = TimeUtil::NanosecondsToTimestamp(absl::ToUnixNanos(link.expires));
}

ControlState::Link RestoreLink(const v1::SavedLink& saved) {
  return {saved.id(), saved.secret_sha256(), saved.role(),
          absl::FromUnixNanos(TimeUtil::TimestampToNanoseconds(saved.expires())), saved.made_by()};
}

// Applies a moment to the run. Requires: the run is at the moment's tick.
absl::Status Apply(const v1::SavedMoment& moment, Run& run) {
  run.set_parameters(SavedParameters(run.model(), moment.session().parameters()));
  const auto pulls = FindPulls(run.model(), moment.session().pulls(), "pulls");
  if (!pulls.ok()) return absl::DataLossError(pulls.status().message());
  return run.ChangePulls(*pulls, true);
}

// Adds the body's part of a state, if it has one.
void SaveBody(const Model& model, const BodyModel& body, v1::SavedScene& scene) {
  if (body.first_vertex < 0 && body.pose < 0) return;
  v1::SavedBody& saved = *scene.add_bodies();
  saved.set_name(body.name);
  saved.set_first_vertex(body.first_vertex);
  saved.set_pose(body.pose);
  if (body.first_vertex < 0) return;
  const Eigen::Matrix3Xf rest = model.rest.middleCols(body.first_vertex, body.mesh.vertices.cols()).cast<float>();
  saved.set_rest(rest.data(), sizeof(float) * static_cast<std::size_t>(rest.size()));
}

absl::Status StepTo(std::int64_t tick, Run& run) {
  while (run.state().tick < tick) {
    if (absl::Status stepped = run.Step(); !stepped.ok()) return absl::DataLossError(stepped.message());
  }
  if (run.state().tick == tick) return absl::OkStatus();
  return absl::DataLossError(absl::StrCat("its journal goes back from tick ", run.state().tick, " to ", tick));
}

}  // namespace

absl::StatusOr<v1::SavedScene> SaveScene(const Model& model, const std::vector<Uploads::Held>& surfaces) {
  v1::SavedScene scene;
  *scene.mutable_source()->mutable_scene() = model.scene;
  scene.set_scene_hash(model.report.scene_hash());
  for (const Uploads::Held& surface : surfaces) {
    auto bytes = surface.Bytes();
    if (!bytes.ok()) return bytes.status();
    v1::SavedSurface& saved = *scene.add_surfaces();
    saved.set_name(surface.file.name);
    saved.set_content(*std::move(bytes));
  }
  for (const BodyModel& body : model.bodies) SaveBody(model, body, scene);
  for (const ScalarCoordinate& scalar : model.scalars) scene.add_scalars(scalar.name);
  return scene;
}

absl::StatusOr<Compiled> CompileSaved(const v1::SavedScene& saved, const std::string& owner, Models& models) {
  auto compiled = models.Restore(saved, owner);
  if (compiled.ok()) compiled->same = compiled->model->report.scene_hash() == saved.scene_hash();
  return compiled;
}

absl::StatusOr<Compiled> RestoreScene(const v1::SavedScene& saved, const std::string& what, const std::string& owner,
                                      Models& models) {
  auto compiled = CompileSaved(saved, owner, models);
  if (!compiled.ok() || compiled->same) return compiled;
  return absl::FailedPreconditionError(absl::StrCat(
      what, ": the surface files of its scene \"", compiled->model->scene.name(),
      "\", or the version of Phrenic, differ from those that it was made with: restore the files and restart "
      "the server"));
}

v1::SavedControl SaveControl(const ControlState& state) {
  v1::SavedControl saved;
  saved.set_policy(state.policy);
  SavePerson(state.owner, *saved.mutable_owner());
  for (const Person& person : state.people) SavePerson(person, *saved.add_people());
  saved.set_holder(state.holder);
  saved.set_revision(state.revision);
  saved.set_account(state.account);
  saved.set_account_qualified(true);
  for (const ControlState::Link& link : state.links) SaveLink(link, *saved.add_links());
  return saved;
}

ControlState RestoreControl(const v1::SavedControl& saved) {
  ControlState state;
  state.policy = saved.policy();
  state.owner = RestorePerson(saved.owner());
  for (const v1::SavedPerson& person : saved.people()) state.people.push_back(RestorePerson(person));
  state.holder = saved.holder();
  state.revision = saved.revision();
  state.account = saved.account();
  for (const v1::SavedLink& link : saved.links()) state.links.push_back(RestoreLink(link));
  return state;
}

v1::Parameters SavedParameters(const Model& model, const v1::Parameters& saved) {
  v1::Parameters parameters = model.parameters;
  parameters.MergeFrom(saved);
  return parameters;
}

absl::Status ReplayJournal(const std::vector<v1::SavedMoment>& later, Run& run) {
  for (const v1::SavedMoment& moment : later) {
    if (moment.from_start()) run.Reset();
    if (absl::Status status = StepTo(moment.session().tick(), run); !status.ok()) return status;
    if (absl::Status status = Apply(moment, run); !status.ok()) return status;
  }
  return absl::OkStatus();
}

absl::StatusOr<Replayed> Replay(std::shared_ptr<const Model> model, const store::SavedSession& saved) {
  absl::StatusOr<State> state = store::Restore(*model, saved.state);
  if (!state.ok()) return state.status();
  v1::Parameters parameters = SavedParameters(*model, saved.moment.session().parameters());
  Run run(std::move(model), std::move(parameters), *std::move(state));
  if (absl::Status status = ReplayJournal(saved.later, run); !status.ok()) return status;
  return Replayed{run.state(), saved.later.empty() ? saved.moment : saved.later.back()};
}

}  // namespace phrenic::session
