#include "client/connection/connection.h"

#include <grpcpp/create_channel.h>
#include <grpcpp/support/client_interceptor.h>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <thread>
#include <utility>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"
#include "client/terminal/environment.h"
#include "phrenic/v1/server.grpc.pb.h"
#include "server/schema/file_bytes.h"
#include "server/service/net/address.h"
#include "server/service/net/metadata.h"

namespace phrenic::client {
namespace {

constexpr int kLinkSeconds = 5;  // deadline of the call that only finds the viewer's address

// Returns the file's text without surrounding white space; empty if it cannot be read.
std::string FileText(const std::string& file) {
  return std::string(absl::StripAsciiWhitespace(ReadBytes(file).value_or("")));
}

using Metadata = std::vector<std::pair<std::string, std::string>>;

// The metadata that identifies the caller.
Metadata MetadataOf(const Context& context) {
  Metadata metadata;
  const std::string token =
      context.token_file.empty() ? EnvironmentVariable("PHRENIC_TOKEN") : FileText(context.token_file);
  if (!token.empty()) metadata.emplace_back("authorization", absl::StrCat("Bearer ", token));
  if (const std::string join = EnvironmentVariable("PHRENIC_JOIN"); !join.empty())
    metadata.emplace_back("x-join", join);
  return metadata;
}

// Adds the caller's metadata to each call. gRPC's own call credentials require an encrypted channel, which loopback
// does not need.
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
  const service::Metadata metadata = {{"x-session-id", id}};  // of use to proxies only
  if (!id.empty() && service::CheckMetadata(metadata).ok()) call.AddMetadata("x-session-id", id);
}

absl::Status CheckConnection(const Context& context) {
  for (const auto& [flag, file] : {std::pair("--tls-ca", context.tls_ca),
                                   {"--tls-cert", context.tls_cert},
                                   {"--tls-key", context.tls_key},
                                   {"--token-file", context.token_file}}) {
    if (!file.empty() && FileText(file).empty()) {
      return absl::InvalidArgumentError(absl::StrCat(flag, ": ", file, " cannot be read or is empty"));
    }
  }
  if (context.tls_cert.empty() != context.tls_key.empty()) {
    return absl::InvalidArgumentError("--tls-cert, --tls-key: a client certificate needs both");
  }
  for (const auto& [name, value] : MetadataOf(context)) {
    if (service::CheckMetadata({{name, value}}).ok()) continue;
    return absl::InvalidArgumentError(
        absl::StrCat(name == "x-join"             ? "PHRENIC_JOIN"
                     : context.token_file.empty() ? "PHRENIC_TOKEN"
                                                  : "--token-file",
                     ": the text is not a token: it has characters other than printable ASCII"));
  }
  const auto address = service::ParseAddress(HostOf(context));
  const bool secret = !MetadataOf(context).empty();
  if (!secret || IsEncrypted(context) || !address.ok() || service::IsLoopback(*address)) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat("--server: the token would be sent to ", context.server,
                                                 " unencrypted, readable by others on the network; use https://",
                                                 context.server));
}

std::shared_ptr<grpc::Channel> Connect(const Context& context) {
  grpc::ChannelArguments arguments;
  arguments.SetMaxReceiveMessageSize(64 << 20);
  arguments.SetInt(GRPC_ARG_ENABLE_HTTP_PROXY, 0);
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, 1000);
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIME_MS, 10'000);  // detects a broken connection while nothing is sent
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, 3'000);
  std::vector<std::unique_ptr<grpc::experimental::ClientInterceptorFactoryInterface>> factories;
  if (auto metadata = MetadataOf(context); !metadata.empty()) {
    factories.push_back(std::make_unique<CredentialFactory>(std::move(metadata)));
  }
  return grpc::experimental::CreateCustomChannelWithInterceptors(HostOf(context), CredentialsOf(context), arguments,
                                                                 std::move(factories));
}

grpc::Status StreamWithReconnect(const Context& context, absl::FunctionRef<grpc::Status(OnReceived received)> stream) {
  constexpr int kAttempts = 60;
  grpc::Status status;
  bool ever_received = false, lost = false;
  const auto received = [&] {
    if (lost) std::cerr << "phrenic: the server at " << context.server << " is back\n";
    ever_received = true, lost = false;
  };
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    status = stream(received);
    const bool interrupted = context.interruption != nullptr && context.interruption->happened();
    if (status.error_code() != grpc::StatusCode::UNAVAILABLE || !ever_received || interrupted) break;
    if (!lost) {
      std::cerr << "phrenic: the server at " << context.server << " does not answer; waiting for it\n";
      lost = true;
      attempt = 0;
    }
    std::this_thread::sleep_for(std::chrono::seconds(1));
  }
  return status;
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

}  // namespace phrenic::client
