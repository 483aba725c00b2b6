#include "server/service/routing/session_router.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/dynamic_message.h>
#include <grpcpp/create_channel.h>
#include <grpcpp/support/proto_buffer_reader.h>

#include <algorithm>
#include <set>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "phrenic/v1/compare.pb.h"
#include "phrenic/v1/session.pb.h"
#include "server/service/calls/peer.h"
#include "server/service/routing/forwarded_call.h"
#include "server/service/web/web_headers.h"

namespace phrenic::service {
namespace {

using cluster::Place;
using google::protobuf::Message;
using google::protobuf::MethodDescriptor;

constexpr char kSessionHeader[] = "x-session-id", kViaHeader[] = "x-phrenic-via";

// Null for one that is not Phrenic's.
const MethodDescriptor* MethodOf(const std::string& method) {
  const std::string name = absl::StrReplaceAll(method.substr(std::min<std::size_t>(1, method.size())), {{"/", "."}});
  return google::protobuf::DescriptorPool::generated_pool()->FindMethodByName(name);
}

bool ParseBytes(const grpc::ByteBuffer& bytes, Message& message) {
  grpc::ByteBuffer copy = bytes;  // shares the bytes
  grpc::ProtoBufferReader reader(&copy);
  return message.ParseFromZeroCopyStream(&reader);
}

// "session_id" of the request; empty where it has none.
std::string SessionOf(const MethodDescriptor* method, const grpc::ByteBuffer& request) {
  const auto* field = method == nullptr ? nullptr : method->input_type()->FindFieldByName("session_id");
  if (field == nullptr || field->cpp_type() != google::protobuf::FieldDescriptor::CPPTYPE_STRING) return "";
  const std::unique_ptr<Message> message(
      google::protobuf::MessageFactory::generated_factory()->GetPrototype(method->input_type())->New());
  return ParseBytes(request, *message) ? message->GetReflection()->GetString(*message, field) : "";
}

// Of a comparison, a session that it is of.
std::string ComparedSession(const std::string& method, const grpc::ByteBuffer& request) {
  v1::CompareRequest compare;
  if (method != "/phrenic.v1.CompareService/Compare" || !ParseBytes(request, compare)) return "";
  return compare.a().has_body() ? compare.a().body().session_id() : compare.b().body().session_id();
}

std::string HeaderOf(const SessionRouter::Metadata& metadata, const char* name) {
  const auto found = metadata.find(name);
  return found == metadata.end() ? "" : found->second;
}

// Lists of what each server has of its own.
bool IsOfAll(const std::string& method) {
  static const std::set<std::string> methods = {
      "/phrenic.v1.SessionService/ListSessions", "/phrenic.v1.ExportService/ListExports",
      "/phrenic.v1.StudyService/ListStudies", "/phrenic.v1.UploadService/ListUploads"};
  return methods.contains(method);
}

bool NamesSomething(const MethodDescriptor* method) {
  if (method == nullptr) return false;
  const auto has = [method](const char* field) { return method->input_type()->FindFieldByName(field) != nullptr; };
  return has("export_id") || has("study_id") || has("upload_id") || has("path") || has("source");
}

std::shared_ptr<grpc::Channel> ChannelTo(const std::string& address) {
  grpc::ChannelArguments arguments;
  arguments.SetMaxReceiveMessageSize(-1);
  arguments.SetInt(GRPC_ARG_ENABLE_HTTP_PROXY, 0);
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 100);
  arguments.SetInt(GRPC_ARG_MIN_RECONNECT_BACKOFF_MS, 200);
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, 1000);
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIME_MS, 10'000);
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, 3'000);
  return grpc::CreateCustomChannel(address, grpc::InsecureChannelCredentials(), arguments);
}

// Pages of several lists, each in the order of the ids, as one page.
grpc::ByteBuffer OnePage(const grpc::ByteBuffer& request, const std::vector<grpc::ByteBuffer>& answers) {
  constexpr int kUsual = 100;
  v1::ListSessionsRequest asked;
  ParseBytes(request, asked);
  std::map<std::string, v1::Session> sessions;
  bool more = false;
  for (const grpc::ByteBuffer& answer : answers) {
    v1::ListSessionsResponse page;
    if (!ParseBytes(answer, page)) continue;
    more = more || !page.next_page_token().empty();
    for (v1::Session& session : *page.mutable_sessions()) {
      v1::Session& known = sessions[session.id()];
      if (known.id().empty() || known.epoch() < session.epoch()) known = std::move(session);
    }
  }
  const auto most = static_cast<std::size_t>(asked.page_size() > 0 ? asked.page_size() : kUsual);
  more = more || sessions.size() > most;
  v1::ListSessionsResponse page;
  for (auto& [id, session] : sessions) {
    if (static_cast<std::size_t>(page.sessions_size()) == most) break;
    *page.add_sessions() = std::move(session);
  }
  if (more && page.sessions_size() > 0) page.set_next_page_token(page.sessions().rbegin()->id());
  const grpc::Slice slice(page.SerializeAsString());
  return grpc::ByteBuffer(&slice, 1);
}

}  // namespace

void SessionRouter::set_here(std::shared_ptr<grpc::Channel> channel) {
  here_ = std::make_shared<grpc::GenericStub>(std::move(channel));
}

grpc::ServerGenericBidiReactor* SessionRouter::CreateReactor(grpc::GenericCallbackServerContext* context) {
  return ForwardedCall::Make(*this, *context);
}

std::shared_ptr<grpc::GenericStub> SessionRouter::StubOf(const std::string& address) {
  absl::MutexLock lock(&mutex_);
  auto& stub = stubs_[address];
  if (stub == nullptr) stub = std::make_shared<grpc::GenericStub>(ChannelTo(address));
  return stub;
}

void SessionRouter::AddOthers(Route& route) {
  for (const std::string& address : cluster_.Others()) route.targets.push_back({StubOf(address), address});
}

absl::StatusOr<SessionRouter::Route> SessionRouter::FindSession(const std::string& id) {
  const Place place = cluster_.Where(id);
  switch (place.kind) {
    case Place::Kind::kHere:
    case Place::Kind::kNowhere:
      return Route{id, {{here_, ""}}};
    case Place::Kind::kElsewhere:
      return Route{id, {{StubOf(place.address), place.address}}};
    case Place::Kind::kBetween:
      return absl::UnavailableError(
          absl::StrCat("session \"", id.substr(0, 64), "\" is on its way to another server; ask again in a moment"));
    case Place::Kind::kUnknown:
      break;
  }
  return absl::UnavailableError(absl::StrCat("session \"", id.substr(0, 64), "\" is not on this server, and where it ",
                                             "is cannot be known: Redis does not answer; start it"));
}

absl::StatusOr<SessionRouter::Route> SessionRouter::Find(const std::string& method, const Metadata& metadata,
                                                         const grpc::ByteBuffer& request) {
  const MethodDescriptor* known = MethodOf(method);
  if (!HeaderOf(metadata, kViaHeader).empty()) {
    Route route{SessionOf(known, request), {{here_, ""}}};
    const Place::Kind kind = route.session.empty() ? Place::Kind::kHere : cluster_.Where(route.session).kind;
    if (kind == Place::Kind::kHere || kind == Place::Kind::kNowhere) return route;
    return absl::UnavailableError(absl::StrCat("session \"", route.session, "\" has moved; ask again"));
  }
  const bool of_all = IsOfAll(method);
  std::string session = of_all ? "" : SessionOf(known, request);
  if (session.empty()) session = ComparedSession(method, request);
  if (session.empty() && !of_all) session = HeaderOf(metadata, kSessionHeader);
  absl::StatusOr<Route> route = session.empty() ? Route{"", {{here_, ""}}} : FindSession(session);
  if (!route.ok()) return route;
  route->all = of_all;
  const bool here = route->targets.size() == 1 && route->targets[0].address.empty();
  if (here && (of_all || NamesSomething(known))) AddOthers(*route);
  return route;
}

void SessionRouter::NoteGone(const Route& route) {
  if (!route.session.empty()) cluster_.Forget(route.session);
}

SessionRouter::Metadata SessionRouter::MetadataOf(const grpc::GenericCallbackServerContext& context) {
  Metadata metadata;
  for (const auto& [key, value] : context.client_metadata()) {
    const std::string name(key.data(), key.size());
    if (name != kPeerHeader && (absl::StartsWith(name, "x-") || name == "authorization")) {
      metadata.emplace(name, std::string(value.data(), value.size()));
    }
  }
  return metadata;
}

SessionRouter::Metadata SessionRouter::MetadataFor(const Target& target, Metadata metadata,
                                                   const std::string& peer) const {
  if (target.address.empty()) {
    metadata.emplace(kPeerHeader, peer);
  } else {
    metadata.emplace(kViaHeader, cluster_.address());
  }
  return metadata;
}

// A message's bytes after another's are both of them: lists one after the other.
grpc::ByteBuffer Together(const std::string& method, const grpc::ByteBuffer& request,
                          const std::vector<grpc::ByteBuffer>& answers) {
  if (absl::EndsWith(method, "/ListSessions")) return OnePage(request, answers);
  std::vector<grpc::Slice> slices;
  for (const grpc::ByteBuffer& answer : answers) {
    std::vector<grpc::Slice> part;
    if (answer.Valid() && answer.Dump(&part).ok()) slices.insert(slices.end(), part.begin(), part.end());
  }
  return grpc::ByteBuffer(slices.data(), slices.size());
}

}  // namespace phrenic::service
