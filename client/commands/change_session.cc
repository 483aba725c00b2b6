// Commands that change a session: `phrenic set`, `pull`, `play`, `step`, `pause`, `reset` and `delete`.
#include "client/cli/argument_kinds.h"
#include "client/cli/shared_options.h"
#include "client/commands/commands.h"
#include "client/files/tokens.h"
#include "client/print/show_session.h"
#include "client/terminal/progress.h"
#include "phrenic/v1/session.grpc.pb.h"

namespace phrenic::client {
namespace {

using SessionStub = v1::SessionService::Stub;

constexpr int kStepsSeconds = 3600;  // deadline; a million steps of a large scene take many minutes

struct SetOptions {
  std::string id;
  std::string preset;
  std::vector<std::string> settings;
  long at_tick = -1;            // -1: at once
  long expected_revision = -1;  // -1: any
  std::string request_id;
};

struct PullOptions {
  std::string id;
  std::string body;  // empty: none
  int vertex = 0;
  std::vector<double> force = {0, 0, 0};  // [N]; zero releases the vertex
  bool release = false;
};

struct PlayOptions {
  std::string id;
  double speed = 0;  // 0: unchanged
  bool fast = false;
  double until = 0;  // simulated time [s]; 0: no end
  std::string in_step_with;
  bool keep = false;
};

struct StepOptions {
  std::string id;
  long ticks = 1;
  long expected_tick = -1;  // -1: any
  std::string request_id;
};

// Makes the call with the session's control token and shows the session.
template <typename Response, typename Method, typename Request>
int CallAndShow(const Context& context, Method method, Request request, int deadline_seconds = 120) {
  request.set_control_token(TokenOf(context, request.session_id()));
  const auto stub = v1::SessionService::NewStub(Connect(context));
  Response response;
  const grpc::Status status =
      WithProgress("waiting", [&] { return Call(context, *stub, method, request, &response, deadline_seconds); });
  return ShowSession(context, status, response);
}

int SetParameters(const Context& context, const SetOptions& options) {
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
  const grpc::Status status = Call(context, *stub, &SessionStub::UpdateParameters, request, &response);
  for (const std::string& warning : response.warnings()) std::cerr << "phrenic: warning: " << warning << "\n";
  return ShowSession(context, status, response);
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
  return CallAndShow<v1::PullSessionResponse>(context, &SessionStub::PullSession, request);
}

int PlaySession(const Context& context, const PlayOptions& options) {
  v1::PlaySessionRequest request;
  request.set_session_id(options.id);
  if (options.speed > 0) request.set_speed(options.speed);
  request.set_as_fast_as_possible(options.fast);
  request.set_until_time(options.until);
  request.set_in_step_with(options.in_step_with);
  request.set_keep_playing(options.keep);
  return CallAndShow<v1::PlaySessionResponse>(context, &SessionStub::PlaySession, request);
}

int StepSession(const Context& context, const StepOptions& options) {
  v1::StepSessionRequest request;
  request.set_session_id(options.id);
  request.set_ticks(options.ticks);
  if (options.expected_tick >= 0) request.set_expected_tick(options.expected_tick);
  request.set_request_id(options.request_id);
  return CallAndShow<v1::StepSessionResponse>(context, &SessionStub::StepSession, request, kStepsSeconds);
}

int PauseSession(const Context& context, const std::string& id) {
  v1::PauseSessionRequest request;
  request.set_session_id(id);
  return CallAndShow<v1::PauseSessionResponse>(context, &SessionStub::PauseSession, request);
}

int ResetSession(const Context& context, const std::string& id) {
  v1::ResetSessionRequest request;
  request.set_session_id(id);
  return CallAndShow<v1::ResetSessionResponse>(context, &SessionStub::ResetSession, request);
}

int DeleteSession(const Context& context, const std::string& id) {
  v1::DeleteSessionRequest request;
  request.set_session_id(id);
  request.set_control_token(TokenOf(context, id));
  const auto stub = v1::SessionService::NewStub(Connect(context));
  v1::DeleteSessionResponse response;
  const grpc::Status status = Call(context, *stub, &SessionStub::DeleteSession, request, &response);
  if (!status.ok()) return Fail(context, status);
  ForgetToken(context, id);
  if (context.json()) std::cout << Json(response) << "\n";
  return kOk;
}

}  // namespace

CommandFunction SetUpSet(CLI::App& command) {
  const auto options = std::make_shared<SetOptions>();
  AddSession(command, options->id);
  command.add_option("SETTING", options->settings, "name=value of a live parameter");
  AddPreset(command, options->preset);
  command.add_option("--at-tick", options->at_tick, "apply the change when the session reaches this tick");
  command.add_option("--expected-revision", options->expected_revision, "fail if the session is at another revision");
  AddRequestId(command, options->request_id);
  return Bind(&SetParameters, options);
}

CommandFunction SetUpPull(CLI::App& command) {
  const auto options = std::make_shared<PullOptions>();
  AddSession(command, options->id);
  CLI::Option* body = command.add_option("--body", options->body, "a deformable body");
  command.add_option("--vertex", options->vertex, "index of one of its vertices, from 0")->needs(body);
  command.add_option("--force", options->force, "force [N]; zero, the default, releases the vertex")
      ->delimiter(',')
      ->expected(3)
      ->needs(body);
  command.add_flag("--release", options->release, "release all other vertices");
  return Bind(&PullVertex, options);
}

CommandFunction SetUpPlay(CLI::App& command) {
  const auto options = std::make_shared<PlayOptions>();
  AddSession(command, options->id);
  command.add_option("--speed", options->speed, "simulated seconds per second")->check(NumberIn(0.01, 100.0));
  command.add_flag("--fast", options->fast, "as fast as possible");
  command.add_option("--until", options->until, "pause at this simulated time [s]");
  command.add_option("--in-step-with", options->in_step_with, "wait when a frame ahead of this session");
  command.add_flag("--keep", options->keep, "play on without viewers, instead of being paused after some minutes");
  return Bind(&PlaySession, options);
}

CommandFunction SetUpStep(CLI::App& command) {
  const auto options = std::make_shared<StepOptions>();
  AddSession(command, options->id);
  command.add_option("TICKS", options->ticks, "number of steps")->capture_default_str();
  command.add_option("--expected-tick", options->expected_tick, "fail if the session is at another tick");
  AddRequestId(command, options->request_id);
  return Bind(&StepSession, options);
}

CommandFunction SetUpPause(CLI::App& command) { return SetUpWithSession(command, &PauseSession); }
CommandFunction SetUpReset(CLI::App& command) { return SetUpWithSession(command, &ResetSession); }
CommandFunction SetUpDelete(CLI::App& command) { return SetUpWithSession(command, &DeleteSession); }

}  // namespace phrenic::client
