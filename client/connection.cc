#include "client/connection.h"

#include <google/protobuf/util/json_util.h>
#include <grpcpp/create_channel.h>
#include <unistd.h>

#include <iostream>

#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"
#include "client/terminal.h"
#include "phrenic/v1/server.grpc.pb.h"

namespace phrenic::client {
namespace {

constexpr int kLinkSeconds = 5;  // a link is worth no more

// The command that lists what the error did not find.
void SayWhatThereIs(const std::string& error) {
  constexpr std::pair<const char*, const char*> kAnswers[] = {
      {"session_id:", "phrenic sessions; or make one: phrenic create thorax --play"},
      {"export_id:", "phrenic exports list"},
      {"study_id:", "phrenic study list"}};
  for (const auto& [field, command] : kAnswers) {
    if (error.starts_with(field)) std::cerr << "  list them: " << command << "\n";
  }
}

}  // namespace

std::string ErrorName() { return Painted("phrenic:", Ink::kRed, STDERR_FILENO); }

std::shared_ptr<grpc::Channel> Connect(const Context& context) {
  grpc::ChannelArguments arguments;
  arguments.SetMaxReceiveMessageSize(64 << 20);
  arguments.SetInt(GRPC_ARG_ENABLE_HTTP_PROXY, 0);
  return grpc::CreateCustomChannel(context.server, grpc::InsecureChannelCredentials(), arguments);
}

int Fail(const Context& context, const grpc::Status& status) {
  if (context.interruption != nullptr && context.interruption->happened()) {
    std::cerr << ErrorName() << " interrupted\n";
    return kInterrupted;
  }
  if (status.error_code() == grpc::StatusCode::UNAVAILABLE) {
    std::cerr << ErrorName() << " no server at " << context.server << " (" << status.error_message()
              << "): start one with deploy/run or phrenicd, or name another with --server HOST:PORT\n"
              << "  what is wrong: phrenic doctor\n";
    return kUnreachable;
  }
  std::cerr << ErrorName() << " " << status.error_message() << "\n";
  if (status.error_code() == grpc::StatusCode::NOT_FOUND) SayWhatThereIs(status.error_message());
  return status.error_code() == grpc::StatusCode::PERMISSION_DENIED ? kNotAllowed : kFailed;
}

int Fail(const absl::Status& status) {
  std::cerr << ErrorName() << " " << std::string(status.message()) << "\n";
  return kFailed;
}

std::string ViewerLink(const Context& context, const std::string& session) {
  std::string viewer = context.viewer;
  if (viewer.empty()) {
    const auto stub = v1::ServerService::NewStub(Connect(context));
    v1::GetServerResponse server;
    const grpc::Status status =
        Call(context, *stub, &v1::ServerService::Stub::GetServer, v1::GetServerRequest(), &server, kLinkSeconds);
    if (!status.ok() || server.web_port() == 0) return "";
    viewer = absl::StrCat("http://", context.server.substr(0, context.server.rfind(':')), ":", server.web_port());
  }
  return absl::StrCat(absl::StripSuffix(viewer, "/"), "/?session=", session);
}

std::string Json(const google::protobuf::Message& message) {
  google::protobuf::util::JsonPrintOptions options;
  options.preserve_proto_field_names = true;
  options.always_print_primitive_fields = true;
  std::string text;
  (void)google::protobuf::util::MessageToJsonString(message, &text, options);
  return text;
}

}  // namespace phrenic::client
