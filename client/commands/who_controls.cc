// Who may change a session: shown, taken, handed on, given back.
#include <cstdlib>
#include <iostream>

#include "absl/strings/str_cat.h"
#include "client/commands/commands.h"
#include "client/connection/tokens.h"
#include "client/print/print_session.h"
#include "phrenic/v1/control.grpc.pb.h"
#include "phrenic/v1/session.grpc.pb.h"

namespace phrenic::client {
namespace {

using Controls = v1::ControlService::Stub;

template <typename Response>
int ShowAnswer(const Context& context, const grpc::Status& status, const Response& response) {
  if (!status.ok()) return Fail(context, status);
  if (context.json()) {
    std::cout << Json(response) << "\n";
  } else {
    std::cout << ControlText(response.control());
  }
  return kOk;
}

// A request by whoever this user is in that session.
template <typename Request>
Request Signed(const Context& context, const std::string& id) {
  Request request;
  request.set_session_id(id);
  request.set_control_token(TokenOf(context, id));
  return request;
}

absl::Status NotThere(const std::string& id) {
  return absl::FailedPreconditionError(absl::StrCat("you neither made nor entered the session ", id, " of this server ",
                                                    "from this account: `phrenic control take ", id, "` first"));
}

std::string LoginName() {
  const char* name = std::getenv("USER");
  return name == nullptr || *name == '\0' ? "somebody" : name;
}

// Enters under the name, or stays, and keeps the token. Who is known keeps their name where none is given.
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

}  // namespace

int ShowControl(const Context& context, const SessionOptions& options) {
  v1::GetSessionRequest request;
  request.set_session_id(options.id);
  const auto stub = v1::SessionService::NewStub(Connect(context));
  v1::GetSessionResponse response;
  const grpc::Status status = Call(context, *stub, &v1::SessionService::Stub::GetSession, request, &response);
  return ShowAnswer(context, status, response.session());
}

int TakeControl(const Context& context, const TakeControlOptions& options) {
  const auto stub = v1::ControlService::NewStub(Connect(context));
  if (const grpc::Status entered = Enter(context, *stub, options); !entered.ok()) return Fail(context, entered);
  v1::TakeControlResponse response;
  const auto request = Signed<v1::TakeControlRequest>(context, options.id);
  const grpc::Status status = Call(context, *stub, &Controls::TakeControl, request, &response);
  const int code = ShowAnswer(context, status, response);
  if (code != kOk || response.granted()) return code;
  std::cerr << "phrenic: " << response.control().controller()
            << " controls the session, and is told that you ask; `phrenic control show` says when it is yours\n";
  return kFailed;
}

int HandControl(const Context& context, const HandControlOptions& options) {
  auto request = Signed<v1::HandControlRequest>(context, options.id);
  if (request.control_token().empty()) return Fail(NotThere(options.id));
  request.set_name(options.name);
  const auto stub = v1::ControlService::NewStub(Connect(context));
  v1::HandControlResponse response;
  return ShowAnswer(context, Call(context, *stub, &Controls::HandControl, request, &response), response);
}

int LendControl(const Context& context, const SessionOptions& options) {
  auto request = Signed<v1::HandControlRequest>(context, options.id);
  if (request.control_token().empty()) return Fail(NotThere(options.id));
  request.set_everybody(true);
  const auto stub = v1::ControlService::NewStub(Connect(context));
  v1::HandControlResponse response;
  return ShowAnswer(context, Call(context, *stub, &Controls::HandControl, request, &response), response);
}

int ReleaseControl(const Context& context, const SessionOptions& options) {
  const auto request = Signed<v1::ReleaseControlRequest>(context, options.id);
  if (request.control_token().empty()) return Fail(NotThere(options.id));
  const auto stub = v1::ControlService::NewStub(Connect(context));
  v1::ReleaseControlResponse response;
  return ShowAnswer(context, Call(context, *stub, &Controls::ReleaseControl, request, &response), response);
}

}  // namespace phrenic::client
