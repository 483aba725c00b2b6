// `phrenic control`: who may change a session.
#include <iostream>

#include "absl/strings/str_cat.h"
#include "client/cli/argument_kinds.h"
#include "client/cli/shared_options.h"
#include "client/commands/commands.h"
#include "client/connection/connection.h"
#include "client/connection/errors.h"
#include "client/files/tokens.h"
#include "client/print/output.h"
#include "client/print/print_session.h"
#include "client/terminal/environment.h"
#include "phrenic/v1/control.grpc.pb.h"
#include "phrenic/v1/session.grpc.pb.h"

namespace phrenic::client {
namespace {

using Controls = v1::ControlService::Stub;

struct TakeControlOptions {
  std::string id, name;
  double minutes = 10;
};

struct HandControlOptions {
  std::string id, name;
};

template <typename Response>
int ShowControlOf(const Context& context, const grpc::Status& status, const Response& response) {
  if (!status.ok()) return Fail(context, status);
  if (context.json()) {
    std::cout << Json(response) << "\n";
  } else {
    std::cout << ControlText(response.control());
  }
  return kOk;
}

// Returns a request with this user's control token of the session.
template <typename Request>
Request Signed(const Context& context, const std::string& id) {
  Request request;
  request.set_session_id(id);
  request.set_control_token(TokenOf(context, id));
  return request;
}

absl::Status NoToken(const std::string& id) {
  return absl::FailedPreconditionError(absl::StrCat("no control token for the session ", id,
                                                    " of this server: type `phrenic control take ", id, "` first"));
}

std::string LoginName() {
  const std::string name = EnvironmentVariable("USER");
  return name.empty() ? "unnamed" : name;
}

// Enters the session and stores the token. A participant without a new name keeps the old one; others get the login
// name.
grpc::Status Enter(const Context& context, Controls& stub, const TakeControlOptions& options) {
  auto request = Signed<v1::EnterSessionRequest>(context, options.id);
  request.set_name(options.name);
  request.set_time_to_live(60 * options.minutes);
  v1::EnterSessionResponse entered;
  grpc::Status status = Call(context, stub, &Controls::EnterSession, request, &entered);
  if (status.error_code() == grpc::StatusCode::INVALID_ARGUMENT && options.name.empty()) {
    request.set_name(LoginName());
    status = Call(context, stub, &Controls::EnterSession, request, &entered);
  }
  if (status.ok()) KeepToken(context, options.id, entered.control_token());
  return status;
}

int ShowControl(const Context& context, const std::string& id) {
  v1::GetSessionRequest request;
  request.set_session_id(id);
  const auto stub = v1::SessionService::NewStub(Connect(context));
  v1::GetSessionResponse response;
  const grpc::Status status = Call(context, *stub, &v1::SessionService::Stub::GetSession, request, &response);
  return ShowControlOf(context, status, response.session());
}

int TakeControl(const Context& context, const TakeControlOptions& options) {
  const auto stub = v1::ControlService::NewStub(Connect(context));
  if (const grpc::Status entered = Enter(context, *stub, options); !entered.ok()) return Fail(context, entered);
  v1::TakeControlResponse response;
  const auto request = Signed<v1::TakeControlRequest>(context, options.id);
  const grpc::Status status = Call(context, *stub, &Controls::TakeControl, request, &response);
  const int code = ShowControlOf(context, status, response);
  if (code != kOk || response.granted()) return code;
  std::cerr << "phrenic: " << response.control().controller()
            << " controls the session and was asked for control; `phrenic control show` shows the controller\n";
  return kFailed;
}

int HandControl(const Context& context, const HandControlOptions& options) {
  auto request = Signed<v1::HandControlRequest>(context, options.id);
  if (request.control_token().empty()) return Fail(NoToken(options.id));
  request.set_name(options.name);
  const auto stub = v1::ControlService::NewStub(Connect(context));
  v1::HandControlResponse response;
  return ShowControlOf(context, Call(context, *stub, &Controls::HandControl, request, &response), response);
}

int LendControl(const Context& context, const std::string& id) {
  auto request = Signed<v1::HandControlRequest>(context, id);
  if (request.control_token().empty()) return Fail(NoToken(id));
  request.set_everybody(true);
  const auto stub = v1::ControlService::NewStub(Connect(context));
  v1::HandControlResponse response;
  return ShowControlOf(context, Call(context, *stub, &Controls::HandControl, request, &response), response);
}

int ReleaseControl(const Context& context, const std::string& id) {
  const auto request = Signed<v1::ReleaseControlRequest>(context, id);
  if (request.control_token().empty()) return Fail(NoToken(id));
  const auto stub = v1::ControlService::NewStub(Connect(context));
  v1::ReleaseControlResponse response;
  return ShowControlOf(context, Call(context, *stub, &Controls::ReleaseControl, request, &response), response);
}

}  // namespace

CommandFunction SetUpControlShow(CLI::App& command) { return SetUpWithSession(command, &ShowControl); }

CommandFunction SetUpControlTake(CLI::App& command) {
  const auto options = std::make_shared<TakeControlOptions>();
  AddSession(command, options->id);
  command.add_option("--name", options->name, "your name as others see it (your login name)");
  command.add_option("--minutes", options->minutes, "control ends after this time without a command of yours [min]")
      ->check(NumberIn(1.0 / 60, 60.0))
      ->capture_default_str();
  return Bind(&TakeControl, options);
}

CommandFunction SetUpControlHand(CLI::App& command) {
  const auto options = std::make_shared<HandControlOptions>();
  AddSession(command, options->id);
  command.add_option("NAME", options->name, "a participant; `phrenic control show` lists them")->required();
  return Bind(&HandControl, options);
}

CommandFunction SetUpControlLend(CLI::App& command) { return SetUpWithSession(command, &LendControl); }
CommandFunction SetUpControlRelease(CLI::App& command) { return SetUpWithSession(command, &ReleaseControl); }

}  // namespace phrenic::client
