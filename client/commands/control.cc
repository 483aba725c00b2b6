// The commands that change a session and show it as it is then.
#include <iostream>
#include <nlohmann/json.hpp>

#include "client/cli/scene_argument.h"
#include "client/commands/commands.h"
#include "client/connection/tokens.h"
#include "client/print/print_session.h"
#include "client/terminal/progress.h"
#include "phrenic/v1/session.grpc.pb.h"

namespace phrenic::client {
namespace {

constexpr int kStepsSeconds = 3600;  // a million steps of a large scene are many minutes

// Of one that was made, `viewer` is the link to it; empty: none.
template <typename Response>
int Show(const Context& context, const grpc::Status& status, const Response& response, const std::string& viewer = "") {
  if (!status.ok()) return Fail(context, status);
  if (context.json()) {
    auto answer = nlohmann::ordered_json::parse(Json(response));
    if (!viewer.empty()) answer["viewer"] = viewer;
    std::cout << answer.dump() << "\n";
  } else {
    PrintSession(response.session(), std::cout);
    if (!viewer.empty()) std::cout << "  viewer: " << viewer << "\n";
  }
  return response.session().state() == v1::SESSION_STATE_DIVERGED ? kFailed : kOk;
}

template <typename Response, typename Method, typename Request>
int CallAndShow(const Context& context, Method method, Request request, int deadline_seconds = 120) {
  request.set_control_token(TokenOf(context, request.session_id()));
  const auto stub = v1::SessionService::NewStub(Connect(context));
  Response response;
  const grpc::Status status =
      WithProgress("waiting", [&] { return Call(context, *stub, method, request, &response, deadline_seconds); });
  return Show(context, status, response);
}

// Lets the session play, and writes down what it is then.
grpc::Status StartPlaying(const Context& context, v1::SessionService::Stub& stub, v1::Session& session) {
  v1::PlaySessionRequest request;
  request.set_session_id(session.id());
  request.set_control_token(TokenOf(context, session.id()));
  v1::PlaySessionResponse playing;
  grpc::Status status = Call(context, stub, &v1::SessionService::Stub::PlaySession, request, &playing);
  if (status.ok()) session = playing.session();
  return status;
}

v1::ControlPolicy PolicyOf(bool mine) { return mine ? v1::CONTROL_POLICY_OWNER : v1::CONTROL_POLICY_EVERYBODY; }

// Of a session that was just made: keeps the owner's token, and lets it play where that was asked for.
template <typename Response>
int ShowOwn(const Context& context, v1::SessionService::Stub& stub, grpc::Status status, bool play,
            Response& response) {
  if (status.ok() && !response.control_token().empty()) {
    KeepToken(context, response.session().id(), response.control_token());
  }
  if (status.ok() && play) status = StartPlaying(context, stub, *response.mutable_session());
  return Show(context, status, response, status.ok() ? ViewerLink(context, response.session().id()) : "");
}

}  // namespace

int Create(const Context& context, const CreateOptions& options) {
  v1::CreateSessionRequest request;
  request.set_preset(options.preset);
  request.set_session_id(options.id);
  request.set_control(PolicyOf(options.mine));
  request.set_owner_name(options.name);
  absl::StatusOr<v1::SceneSource> source = ReadSceneArgument(options.scene.scene, options.scene.resolution_mm);
  if (!source.ok()) return Fail(source.status());
  *request.mutable_source() = *std::move(source);
  absl::StatusOr<v1::Parameters> parameters = ReadSettings(options.settings);
  if (!parameters.ok()) return Fail(parameters.status());
  *request.mutable_parameters() = *std::move(parameters);
  const auto pulls = ReadPulls(options.pulls);
  if (!pulls.ok()) return Fail(pulls.status());
  *request.mutable_pulls() = *pulls;
  const auto stub = v1::SessionService::NewStub(Connect(context));
  v1::CreateSessionResponse response;
  const grpc::Status status = WithProgress("compiling " + options.scene.scene, [&] {
    return Call(context, *stub, &v1::SessionService::Stub::CreateSession, request, &response);
  });
  return ShowOwn(context, *stub, status, options.play, response);
}

int Fork(const Context& context, const ForkOptions& options) {
  v1::ForkSessionRequest request;
  request.set_session_id(options.id);
  request.set_fork_id(options.fork_id);
  request.set_control(PolicyOf(options.mine));
  request.set_owner_name(options.name);
  const auto stub = v1::SessionService::NewStub(Connect(context));
  v1::ForkSessionResponse response;
  const grpc::Status status = Call(context, *stub, &v1::SessionService::Stub::ForkSession, request, &response);
  return ShowOwn(context, *stub, status, options.play, response);
}

int Set(const Context& context, const SetOptions& options) {
  v1::UpdateParametersRequest request;
  request.set_session_id(options.id);
  absl::StatusOr<v1::Parameters> parameters = ReadSettings(options.settings);
  if (!parameters.ok()) return Fail(parameters.status());
  *request.mutable_parameters() = *std::move(parameters);
  request.set_preset(options.preset);
  if (options.at_tick >= 0) request.set_apply_at_tick(options.at_tick);
  if (options.expected_revision >= 0) request.set_expected_revision(options.expected_revision);
  request.set_request_id(options.request_id);
  request.set_control_token(TokenOf(context, options.id));
  const auto stub = v1::SessionService::NewStub(Connect(context));
  v1::UpdateParametersResponse response;
  const grpc::Status status = Call(context, *stub, &v1::SessionService::Stub::UpdateParameters, request, &response);
  for (const std::string& warning : response.warnings()) std::cerr << "phrenic: warning: " << warning << "\n";
  return Show(context, status, response);
}

int PullVertex(const Context& context, const PullOptions& options) {
  v1::PullSessionRequest request;
  request.set_session_id(options.id);
  request.set_release_others(options.release);
  if (!options.body.empty()) {
    v1::Pull& pull = *request.add_pulls();
    pull.set_body(options.body);
    pull.set_vertex(options.vertex);
    pull.mutable_force()->set_x(options.force[0]);
    pull.mutable_force()->set_y(options.force[1]);
    pull.mutable_force()->set_z(options.force[2]);
  }
  return CallAndShow<v1::PullSessionResponse>(context, &v1::SessionService::Stub::PullSession, request);
}

int Play(const Context& context, const PlayOptions& options) {
  v1::PlaySessionRequest request;
  request.set_session_id(options.id);
  if (options.speed > 0) request.set_speed(options.speed);
  request.set_as_fast_as_possible(options.fast);
  request.set_until_time(options.until);
  request.set_in_step_with(options.in_step_with);
  return CallAndShow<v1::PlaySessionResponse>(context, &v1::SessionService::Stub::PlaySession, request);
}

int Pause(const Context& context, const SessionOptions& options) {
  v1::PauseSessionRequest request;
  request.set_session_id(options.id);
  return CallAndShow<v1::PauseSessionResponse>(context, &v1::SessionService::Stub::PauseSession, request);
}

int TakeSteps(const Context& context, const StepOptions& options) {
  v1::StepSessionRequest request;
  request.set_session_id(options.id);
  request.set_ticks(options.ticks);
  if (options.expected_tick >= 0) request.set_expected_tick(options.expected_tick);
  request.set_request_id(options.request_id);
  return CallAndShow<v1::StepSessionResponse>(context, &v1::SessionService::Stub::StepSession, request, kStepsSeconds);
}

int Reset(const Context& context, const SessionOptions& options) {
  v1::ResetSessionRequest request;
  request.set_session_id(options.id);
  return CallAndShow<v1::ResetSessionResponse>(context, &v1::SessionService::Stub::ResetSession, request);
}

int Delete(const Context& context, const SessionOptions& options) {
  v1::DeleteSessionRequest request;
  request.set_session_id(options.id);
  request.set_control_token(TokenOf(context, options.id));
  const auto stub = v1::SessionService::NewStub(Connect(context));
  v1::DeleteSessionResponse response;
  const grpc::Status status = Call(context, *stub, &v1::SessionService::Stub::DeleteSession, request, &response);
  if (!status.ok()) return Fail(context, status);
  ForgetToken(context, options.id);
  if (context.json()) std::cout << Json(response) << "\n";
  return kOk;
}

}  // namespace phrenic::client
