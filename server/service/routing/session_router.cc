#include "server/service/routing/session_router.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/dynamic_message.h>
#include <grpcpp/create_channel.h>

#include <algorithm>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "phrenic/v1/compare.pb.h"
#include "server/service/calls/messages.h"
#include "server/service/net/metadata_keys.h"
#include "server/service/routing/merge_responses.h"

namespace phrenic::service {
namespace {

using cluster::Location;
using google::protobuf::Message;
using google::protobuf::MethodDescriptor;

// Returns the descriptor of "/package.Service/Method"; null if it is not one of Phrenic's methods.
const MethodDescriptor* MethodOf(const std::string& method) {
  const std::string name = absl::StrReplaceAll(method.substr(std::min<std::size_t>(1, method.size())), {{"/", "."}});
  return google::protobuf::DescriptorPool::generated_pool()->FindMethodByName(name);
}

// Returns the request's session_id; empty if it has none.
std::string SessionOf(const MethodDescriptor* method, const grpc::ByteBuffer& request) {
  const auto* field = method == nullptr ? nullptr : SessionIdField(*method->input_type());
  if (field == nullptr) return "";
  const std::unique_ptr<Message> message(
      google::protobuf::MessageFactory::generated_factory()->GetPrototype(method->input_type())->New());
  return Parse(request, *message).ok() ? message->GetReflection()->GetString(*message, field) : "";
}

// Returns a session that a Compare request names; empty for other methods.
std::string ComparedSession(const std::string& method, const grpc::ByteBuffer& request) {
  v1::CompareRequest compare;
  if (method != "/phrenic.v1.CompareService/Compare" || !Parse(request, compare).ok()) return "";
  return compare.a().has_body() ? compare.a().body().session_id() : compare.b().body().session_id();
}

std::string Value(const Metadata& metadata, const char* key) {
  const auto found = metadata.find(key);
  return found == metadata.end() ? "" : found->second;
}

// True if the request names something that another server may have: an export, a study, an upload, or a scene that uses
// an upload.
bool NamesResource(const MethodDescriptor* method) {
  if (method == nullptr) return false;
  const auto has = [method](const char* field) { return method->input_type()->FindFieldByName(field) != nullptr; };
  return has("export_id") || has("study_id") || has("upload_id") || has("path") || has("source");
}

// Reconnects within 1 s after a server restarts, and detects a dead one by keepalive within 13 s.
std::shared_ptr<grpc::Channel> ChannelTo(const std::string& address,
                                         const std::shared_ptr<grpc::ChannelCredentials>& credentials) {
  grpc::ChannelArguments arguments;
  arguments.SetMaxReceiveMessageSize(-1);
  arguments.SetInt(GRPC_ARG_ENABLE_HTTP_PROXY, 0);
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 100);
  arguments.SetInt(GRPC_ARG_MIN_RECONNECT_BACKOFF_MS, 200);
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, 1000);
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIME_MS, 10'000);
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, 3'000);
  return grpc::CreateCustomChannel(address, credentials, arguments);
}

}  // namespace

void SessionRouter::set_local_channel(std::shared_ptr<grpc::Channel> channel) {
  local_ = std::make_shared<grpc::GenericStub>(std::move(channel));
}

std::shared_ptr<grpc::GenericStub> SessionRouter::StubOf(const std::string& address) {
  absl::MutexLock lock(&mutex_);
  auto& stub = stubs_[address];
  if (stub == nullptr) stub = std::make_shared<grpc::GenericStub>(ChannelTo(address, credentials_));
  return stub;
}

void SessionRouter::AddOtherServers(Route& route) {
  for (const std::string& address : cluster_.Others()) route.targets.push_back({StubOf(address), address});
}

absl::StatusOr<SessionRouter::Route> SessionRouter::FindSession(const std::string& id) {
  const Location location = cluster_.Locate(id);
  switch (location.kind) {
    case Location::Kind::kLocal:
    case Location::Kind::kNone:
      return Route{id, {{local_, ""}}};
    case Location::Kind::kRemote:
      return Route{id, {{StubOf(location.address), location.address}}};
    case Location::Kind::kMoving:
      return absl::UnavailableError(
          absl::StrCat("session \"", id.substr(0, 64), "\" is moving to another server; try again in a moment"));
    case Location::Kind::kUnknown:
      break;
  }
  return absl::UnavailableError(absl::StrCat("session \"", id.substr(0, 64),
                                             "\" is not on this server, and Redis does not answer where it is; start "
                                             "Redis"));
}

absl::StatusOr<SessionRouter::Route> SessionRouter::FindForwarded(const std::string& session) {
  Route route{session, {{local_, ""}}};
  const Location::Kind kind = session.empty() ? Location::Kind::kLocal : cluster_.Locate(session).kind;
  if (kind == Location::Kind::kLocal || kind == Location::Kind::kNone) return route;
  return absl::UnavailableError(
      absl::StrCat("session \"", session.substr(0, 64), "\" has moved to another server; try again"));
}

absl::StatusOr<SessionRouter::Route> SessionRouter::Find(const std::string& method, const Metadata& metadata,
                                                         const grpc::ByteBuffer& request) {
  const MethodDescriptor* descriptor = MethodOf(method);
  if (!Value(metadata, kForwardedByKey).empty()) return FindForwarded(SessionOf(descriptor, request));
  const bool list = IsListMethod(method);
  std::string session = list ? "" : SessionOf(descriptor, request);
  if (session.empty()) session = ComparedSession(method, request);
  if (session.empty() && !list) session = Value(metadata, kSessionKey);
  absl::StatusOr<Route> route = session.empty() ? Route{"", {{local_, ""}}} : FindSession(session);
  if (!route.ok()) return route;
  route->fan_out = list;
  const bool local = route->targets.size() == 1 && route->targets[0].address.empty();
  if (local && (list || NamesResource(descriptor))) AddOtherServers(*route);
  return route;
}

void SessionRouter::ReportUnreachable(const Route& route) {
  if (!route.session.empty()) cluster_.Forget(route.session);
}

Metadata SessionRouter::ForwardedMetadata(const grpc::ServerContextBase& context) {
  Metadata metadata;
  for (const auto& [key, value] : context.client_metadata()) {
    const std::string name(key.data(), key.size());
    if (name != kPeerKey && (absl::StartsWith(name, "x-") || name == "authorization")) {
      metadata.emplace(name, std::string(value.data(), value.size()));
    }
  }
  return metadata;
}

Metadata SessionRouter::MetadataFor(const Target& target, Metadata metadata, const std::string& peer) const {
  if (target.address.empty()) {
    metadata.emplace(kPeerKey, peer);
  } else {
    metadata.emplace(kForwardedByKey, cluster_.address());
  }
  return metadata;
}

}  // namespace phrenic::service
