#include "client/connection/connection.h"

#include <google/protobuf/util/json_util.h>
#include <grpcpp/create_channel.h>
#include <grpcpp/support/client_interceptor.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string_view>
#include <thread>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"
#include "client/connection/reachable.h"
#include "client/terminal/terminal.h"
#include "phrenic/v1/server.grpc.pb.h"
#include "server/service/net/address.h"

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

// gRPC has one code for a server that is not there and for one that answers that it cannot now.
int FailUnavailable(const Context& context, const std::string& message) {
  if (IsReachable(HostOf(context))) {
    std::cerr << ErrorName() << " the server at " << context.server << " cannot do it now: " << message
              << "\n  try again; what is wrong: phrenic doctor\n";
  } else {
    std::cerr << ErrorName() << " no server at " << context.server << " (" << message
              << "): start one with deploy/run or phrenicd, or name another with --server HOST:PORT\n"
              << "  what is wrong: phrenic doctor\n";
  }
  return kUnreachable;
}

constexpr std::string_view kEncrypted = "https://", kPlainScheme = "http://";

// Without blanks at its ends; empty where it cannot be read.
std::string FileText(const std::string& file) {
  std::ifstream in(file);
  return std::string(absl::StripAsciiWhitespace(std::string(std::istreambuf_iterator<char>(in), {})));
}

std::string VariableText(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

using Metadata = std::vector<std::pair<std::string, std::string>>;

// What says who calls.
Metadata MetadataOf(const Context& context) {
  Metadata metadata;
  const std::string token = context.token_file.empty() ? VariableText("PHRENIC_TOKEN") : FileText(context.token_file);
  if (!token.empty()) metadata.emplace_back("authorization", absl::StrCat("Bearer ", token));
  if (const std::string join = VariableText("PHRENIC_JOIN"); !join.empty()) metadata.emplace_back("x-join", join);
  return metadata;
}

// Signs each call. gRPC's own call credentials work on encrypted channels alone, and here loopback may do without.
class Credential final : public grpc::experimental::Interceptor {
 public:
  explicit Credential(const Metadata& metadata) : metadata_(metadata) {}
  void Intercept(grpc::experimental::InterceptorBatchMethods* methods) override {
    if (methods->QueryInterceptionHookPoint(grpc::experimental::InterceptionHookPoints::PRE_SEND_INITIAL_METADATA)) {
      for (const auto& [name, value] : metadata_) methods->GetSendInitialMetadata()->emplace(name, value);
    }
    methods->Proceed();
  }

 private:
  const Metadata& metadata_;
};

class CredentialFactory final : public grpc::experimental::ClientInterceptorFactoryInterface {
 public:
  explicit CredentialFactory(Metadata metadata) : metadata_(std::move(metadata)) {}
  grpc::experimental::Interceptor* CreateClientInterceptor(grpc::experimental::ClientRpcInfo* /*info*/) override {
    return new Credential(metadata_);
  }

 private:
  const Metadata metadata_;
};

std::shared_ptr<grpc::ChannelCredentials> CredentialsOf(const Context& context) {
  if (!IsEncrypted(context)) return grpc::InsecureChannelCredentials();
  return grpc::SslCredentials({.pem_root_certs = context.tls_ca.empty() ? "" : FileText(context.tls_ca),
                               .pem_private_key = context.tls_key.empty() ? "" : FileText(context.tls_key),
                               .pem_cert_chain = context.tls_cert.empty() ? "" : FileText(context.tls_cert)});
}

}  // namespace

void NameSession(const google::protobuf::Message& request, grpc::ClientContext& call) {
  const auto* field = request.GetDescriptor()->FindFieldByName("session_id");
  if (field == nullptr) return;
  const std::string id = request.GetReflection()->GetString(request, field);
  if (!id.empty()) call.AddMetadata("x-session-id", id);
}

std::string ErrorName() { return Painted("phrenic:", Ink::kRed, STDERR_FILENO); }

std::string HostOf(const Context& context) {
  const std::string_view server = context.server;
  for (const std::string_view scheme : {kEncrypted, kPlainScheme}) {
    if (server.starts_with(scheme)) return std::string(server.substr(scheme.size()));
  }
  return context.server;
}

bool IsEncrypted(const Context& context) {
  return context.server.starts_with(kEncrypted) || !context.tls_ca.empty() || !context.tls_cert.empty();
}

absl::Status CheckConnection(const Context& context) {
  for (const auto& [flag, file] : {std::pair("--tls-ca", context.tls_ca),
                                   {"--tls-cert", context.tls_cert},
                                   {"--tls-key", context.tls_key},
                                   {"--token-file", context.token_file}}) {
    if (!file.empty() && FileText(file).empty()) {
      return absl::InvalidArgumentError(absl::StrCat(flag, ": ", file, " cannot be read, or is empty"));
    }
  }
  if (context.tls_cert.empty() != context.tls_key.empty()) {
    return absl::InvalidArgumentError("--tls-cert, --tls-key: one's own certificate needs both");
  }
  const auto address = service::ParseAddress(HostOf(context));
  const bool secret = !MetadataOf(context).empty();
  if (!secret || IsEncrypted(context) || !address.ok() || service::IsLoopback(*address)) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat("--server: the token would go to ", context.server,
                                                 " unencrypted, for anybody on the way to read; write https://",
                                                 context.server));
}

std::shared_ptr<grpc::Channel> Connect(const Context& context) {
  grpc::ChannelArguments arguments;
  arguments.SetMaxReceiveMessageSize(64 << 20);
  arguments.SetInt(GRPC_ARG_ENABLE_HTTP_PROXY, 0);
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, 1000);
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIME_MS, 10'000);  // a line that was cut is noticed though nothing is sent
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, 3'000);
  std::vector<std::unique_ptr<grpc::experimental::ClientInterceptorFactoryInterface>> factories;
  if (auto metadata = MetadataOf(context); !metadata.empty()) {
    factories.push_back(std::make_unique<CredentialFactory>(std::move(metadata)));
  }
  return grpc::experimental::CreateCustomChannelWithInterceptors(HostOf(context), CredentialsOf(context), arguments,
                                                                 std::move(factories));
}

grpc::Status RideOut(const Context& context, absl::FunctionRef<grpc::Status(Heard heard)> stream) {
  constexpr int kAttempts = 60;
  grpc::Status status;
  bool ever = false, lost = false;
  const auto heard = [&] {
    if (lost) std::cerr << "phrenic: the server at " << context.server << " is back\n";
    ever = true, lost = false;
  };
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    status = stream(heard);
    const bool interrupted = context.interruption != nullptr && context.interruption->happened();
    if (status.error_code() != grpc::StatusCode::UNAVAILABLE || !ever || interrupted) break;
    if (!lost) {
      std::cerr << "phrenic: the server at " << context.server << " is gone; waiting for it\n";
      lost = true;
      attempt = 0;
    }
    std::this_thread::sleep_for(std::chrono::seconds(1));
  }
  return status;
}

int Fail(const Context& context, const grpc::Status& status) {
  if (context.interruption != nullptr && context.interruption->happened()) {
    std::cerr << ErrorName() << " interrupted\n";
    return kInterrupted;
  }
  if (status.error_code() == grpc::StatusCode::UNAVAILABLE) return FailUnavailable(context, status.error_message());
  std::cerr << ErrorName() << " " << status.error_message() << "\n";
  if (status.error_code() == grpc::StatusCode::NOT_FOUND) SayWhatThereIs(status.error_message());
  const bool refused = status.error_code() == grpc::StatusCode::PERMISSION_DENIED ||
                       status.error_code() == grpc::StatusCode::UNAUTHENTICATED;
  return refused ? kNotAllowed : kFailed;
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
    const std::string host = HostOf(context);
    viewer = absl::StrCat(server.encrypted() ? "https://" : "http://", host.substr(0, host.rfind(':')), ":",
                          server.web_port());
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
