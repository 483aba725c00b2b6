// `phrenic create` and `phrenic fork`: new sessions.
#include "client/cli/shared_options.h"
#include "client/commands/commands.h"
#include "client/files/tokens.h"
#include "client/print/show_session.h"
#include "client/terminal/open_page.h"
#include "client/terminal/progress.h"
#include "phrenic/v1/session.grpc.pb.h"

namespace phrenic::client {
namespace {

// The options of every new session.
struct NewSessionOptions {
  std::string id;  // empty: the server chooses
  bool play = false;
  bool mine = false;  // true: only the owner controls it
  std::string name;   // the owner's
  bool web = false;   // open its page
};

struct CreateOptions {
  SceneOptions scene;
  std::string preset;
  std::vector<std::string> settings;
  std::vector<std::string> pulls;
  NewSessionOptions session;
};

struct ForkOptions {
  std::string id;
  NewSessionOptions session;
};

// Starts the session. On success `session` receives its state.
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

// Stores the owner's token of a session that was just created, starts and shows it as the options say.
template <typename Response>
int ShowNewSession(const Context& context, v1::SessionService::Stub& stub, grpc::Status status,
                   const NewSessionOptions& options, Response& response) {
  if (status.ok() && !response.control_token().empty()) {
    KeepToken(context, response.session().id(), response.control_token());
  }
  if (status.ok() && options.play) status = StartPlaying(context, stub, *response.mutable_session());
  const std::string link = status.ok() ? ViewerLink(context, response.session().id()) : "";
  const int code = ShowSession(context, status, response, link);
  if (code != kOk || !options.web) return code;
  if (link.empty())
    return Fail(absl::FailedPreconditionError("--web: the server serves no viewer; give phrenicd --web"));
  const absl::Status opened = OpenPage(link);
  return opened.ok() ? kOk : Fail(opened);
}

int CreateSession(const Context& context, const CreateOptions& options) {
  v1::CreateSessionRequest request;
  request.set_preset(options.preset);
  request.set_session_id(options.session.id);
  request.set_control(PolicyOf(options.session.mine));
  request.set_owner_name(options.session.name);
  absl::StatusOr<v1::SceneSource> source = ReadScene(options.scene);
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
  return ShowNewSession(context, *stub, status, options.session, response);
}

int ForkSession(const Context& context, const ForkOptions& options) {
  v1::ForkSessionRequest request;
  request.set_session_id(options.id);
  request.set_fork_id(options.session.id);
  request.set_control(PolicyOf(options.session.mine));
  request.set_owner_name(options.session.name);
  const auto stub = v1::SessionService::NewStub(Connect(context));
  v1::ForkSessionResponse response;
  const grpc::Status status = Call(context, *stub, &v1::SessionService::Stub::ForkSession, request, &response);
  return ShowNewSession(context, *stub, status, options.session, response);
}

void AddNewSession(CLI::App& command, NewSessionOptions& options) {
  command.add_option("--id", options.id, "name of the new session: 1 to 64 of a-z, 0-9 and -");
  command.add_flag("--play", options.play, "start the session at once");
  command.add_flag("--mine", options.mine, "only you may change the session, until you hand control over");
  command.add_flag("--web", options.web, "open the session in a browser");
  command.add_option("--name", options.name, "your name as others see it");
}

}  // namespace

CommandFunction SetUpCreate(CLI::App& command) {
  const auto options = std::make_shared<CreateOptions>();
  AddScene(command, options->scene);
  AddPreset(command, options->preset);
  AddParameters(command, options->settings);
  AddPulls(command, options->pulls);
  AddNewSession(command, options->session);
  return Bind(&CreateSession, options);
}

CommandFunction SetUpFork(CLI::App& command) {
  const auto options = std::make_shared<ForkOptions>();
  AddSession(command, options->id);
  AddNewSession(command, options->session);
  return Bind(&ForkSession, options);
}

}  // namespace phrenic::client
