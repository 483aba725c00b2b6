#include "server/service/frame_service.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/schema/id.h"
#include "server/schema/part_of.h"
#include "server/service/calls/messages.h"
#include "server/service/calls/session_call.h"
#include "server/service/calls/status.h"
#include "server/service/net/metadata_keys.h"
#include "server/service/watch/claimed_watch.h"
#include "server/service/watch/watch_reactor.h"
#include "server/session/present_forces.h"
#include "server/stream/geometry.h"

namespace phrenic::service {
namespace {

// Returns the indices of the named bodies that are streamed, ascending. INVALID_ARGUMENT for an unknown name.
absl::StatusOr<std::vector<int>> FindBodies(const Model& model, const stream::Layout& layout,
                                            const google::protobuf::RepeatedPtrField<std::string>& names) {
  std::set<int> found;
  for (const std::string& name : names) {
    const auto body = std::find_if(model.bodies.begin(), model.bodies.end(),
                                   [&name](const BodyModel& each) { return each.name == name; });
    if (body == model.bodies.end()) return absl::InvalidArgumentError(absl::StrCat("bodies: there is no body ", name));
    const auto index = static_cast<int>(body - model.bodies.begin());
    if (layout.placement(index) == v1::PLACEMENT_STREAMED) found.insert(index);
  }
  return std::vector<int>(found.begin(), found.end());
}

absl::StatusOr<stream::ViewerOptions> ReadOptions(const Model& model, const stream::Layout& layout,
                                                  const v1::WatchFramesRequest& request) {
  if (absl::Status status = schema::CheckId("watch_id", request.watch_id()); !status.ok()) return status;
  if (request.max_unacked_frames() > 0 && request.watch_id().empty()) {
    return absl::InvalidArgumentError("watch_id: required with max_unacked_frames, because acknowledgements name it");
  }
  auto bodies = FindBodies(model, layout, request.bodies());
  if (!bodies.ok()) return bodies.status();
  if (request.numbers_only()) {
    return stream::ViewerOptions{.max_fps = request.max_fps(),
                                 .encoding = {.numbers_only = true},
                                 .max_unacked = request.max_unacked_frames(),
                                 .watch_id = request.watch_id()};
  }
  const bool raw = request.codec() == v1::CODEC_UNSPECIFIED || request.codec() == v1::CODEC_RAW;
  const bool bounded = request.has_max_error_mm();
  return stream::ViewerOptions{
      .max_fps = request.max_fps(),
      .encoding = {.numbers_only = request.numbers_only(),
                   .codec = raw ? v1::CODEC_RAW : request.codec(),
                   .bound_level =
                       bounded && !raw ? stream::BoundLevelWithin(request.max_error_mm()) : stream::kDefaultBoundLevel,
                   .chosen = !request.bodies().empty(),
                   .bodies = *std::move(bodies)},
      .max_unacked = request.max_unacked_frames(),
      .may_coarsen = !raw && !bounded,
      .watch_id = request.watch_id()};
}

// Returns the bytes of a body's arrays in GetGeometryResponse.
std::size_t GeometryBytes(const Mesh& mesh) {
  const Eigen::Index numbers = mesh.vertices.size() + mesh.triangles.size() + mesh.edges.size();
  return sizeof(float) * static_cast<std::size_t>(numbers);
}

absl::Status Acknowledge(const session::Table& table, const v1::AckFramesRequest& request,
                         v1::AckFramesResponse& response) {
  const auto session = table.Find(request.session_id());
  if (!session.ok()) return session.status();
  auto acknowledged = (*session)->publisher().Acknowledge(request);
  if (!acknowledged.ok()) return acknowledged.status();
  response = *std::move(acknowledged);
  return absl::OkStatus();
}

// Returns the key of the claim that a call carries; empty if it has none.
std::string ClaimOf(const grpc::ServerContextBase& context) {
  const auto key = context.client_metadata().find(kWatchClaimKey);
  return key == context.client_metadata().end() ? "" : std::string(key->second.data(), key->second.size());
}

}  // namespace

FrameService::FrameService(session::Table& table, AccessGuard& guard, Metrics& metrics, const session::Limits& limits,
                           WatchClaims& watches)
    : table_(table),
      guard_(guard),
      metrics_(metrics),
      watches_(watches),
      viewers_({"viewers", "--max-viewers-in-all, --max-share", limits.viewers_in_all,
                PartOf(limits.viewers_in_all, limits.share)}),
      seats_({"viewers of this session", "--max-viewers, --max-share", std::numeric_limits<int>::max(),
              PartOf(limits.viewers, limits.share)}) {}

void FrameService::AddTo(CallTable& calls) {
  calls.AddRaw<v1::WatchFramesRequest>(Lane::kQuick, [this](ServedCall& call) -> std::optional<grpc::Status> {
    if (absl::Status watched = WatchFrames(call); !watched.ok()) return ToGrpc(watched);
    return std::nullopt;
  });
  calls.Add(Lane::kStream, *this, &FrameService::GetGeometry);
  calls.Add(Lane::kQuick, *this, &FrameService::AckFrames);
  calls.Add(Lane::kQuick, *this, &FrameService::GetBasis);
  calls.Add(Lane::kSession, *this, &FrameService::GetForces);
}

grpc::Status FrameService::GetGeometry(grpc::CallbackServerContext* context, const v1::GetGeometryRequest* request,
                                       ReplyStream<v1::GetGeometryResponse>* writer) {
  const auto call = AdmitToSession(guard_, table_, *context, *request);
  if (!call.ok()) return ToGrpc(call.status());
  session::Session& session = *call->session;
  const Model& model = session.model();
  for (const BodyModel& body : model.bodies) {
    if (absl::Status reserved = writer->Reserve(GeometryBytes(body.mesh)); !reserved.ok()) return ToGrpc(reserved);
  }
  for (int body = 0; body < static_cast<int>(model.bodies.size()); ++body) {
    auto turn = TakeTurn(call->caller, *context, GeometryBytes(model.bodies[static_cast<std::size_t>(body)].mesh));
    if (!turn.ok()) return ToGrpc(turn.status());
    const v1::GetGeometryResponse geometry = stream::MakeGeometry(model, session.publisher().layout(), body);
    turn->reset();
    if (!writer->Write(geometry)) break;  // the client disconnected
  }
  return grpc::Status::OK;
}

absl::StatusOr<FairShare::Hold> FrameService::TakeSeats(const access::Caller& caller, const std::string& session) {
  const std::string name = guard_.ShareOf(caller);
  auto viewer = viewers_.Take(name);
  if (!viewer.ok()) return viewer;
  auto seat = seats_.Take(name.empty() ? "" : absl::StrCat(name, " in ", session));
  if (!seat.ok()) return seat;
  return std::make_shared<std::pair<FairShare::Hold, FairShare::Hold>>(*std::move(viewer), *std::move(seat));
}

absl::Status FrameService::WatchFrames(ServedCall& call) {
  v1::WatchFramesRequest request;
  if (absl::Status parsed = Parse(call.request(), request); !parsed.ok()) return parsed;
  const auto caller = guard_.Admit(call.context(), request);
  if (!caller.ok()) return caller.status();
  auto session = table_.Find(request.session_id());
  if (!session.ok()) return session.status();
  const auto options = ReadOptions((*session)->model(), (*session)->publisher().layout(), request);
  if (!options.ok()) return options.status();
  auto seats = TakeSeats(*caller, request.session_id());
  if (!seats.ok()) return seats.status();
  auto may_see = guard_.StillMaySee(*caller, **session);
  WatchStream::Subscription subscription{*std::move(seats), std::move(may_see),
                                         [this](std::size_t sent) { metrics_.CountFrame(sent); }};
  const std::string key = ClaimOf(call.context());
  if (!watches_.Has(key)) {
    return std::make_shared<WatchReactor>(call)->Start(*std::move(session), *options, std::move(subscription));
  }
  return std::make_shared<ClaimedWatch>(call)->Start(*std::move(session), *options, std::move(subscription), key,
                                                     watches_);
}

grpc::Status FrameService::AckFrames(grpc::CallbackServerContext* context, const v1::AckFramesRequest* request,
                                     v1::AckFramesResponse* response) {
  const auto caller = guard_.Admit(*context, *request);
  return ToGrpc(caller.ok() ? Acknowledge(table_, *request, *response) : caller.status());
}

std::optional<absl::StatusOr<std::string>> FrameService::AckFramesAtOnce(const Metadata& metadata,
                                                                         const std::string& message) {
  v1::AckFramesRequest request;
  const auto peer = metadata.find(kPeerKey);
  if (peer == metadata.end() || !request.ParseFromString(message)) return std::nullopt;
  if (!table_.Find(request.session_id()).ok()) return std::nullopt;
  const std::multimap<grpc::string_ref, grpc::string_ref> headers(metadata.begin(), metadata.end());
  const auto caller = guard_.Admit(AccessGuard::Headers{headers, peer->second}, request);
  if (!caller.ok()) return caller.status();
  v1::AckFramesResponse response;
  if (absl::Status status = Acknowledge(table_, request, response); !status.ok()) return status;
  return response.SerializeAsString();
}

grpc::Status FrameService::GetBasis(grpc::CallbackServerContext* context, const v1::GetBasisRequest* request,
                                    v1::GetBasisResponse* response) {
  const auto call = AdmitToSession(guard_, table_, *context, *request);
  if (!call.ok()) return ToGrpc(call.status());
  const auto basis = call->session->publisher().basis();
  if (basis == nullptr) return grpc::Status::OK;
  response->set_epoch(basis->epoch);
  for (const std::string& shape : basis->encoded) response->add_shapes(shape);
  return grpc::Status::OK;
}

absl::StatusOr<FairShare::Hold> FrameService::TakeTurn(const access::Caller& caller,
                                                       const grpc::ServerContextBase& context, std::size_t bytes) {
  if (bytes <= kLargeRead) return FairShare::Hold();
  auto turn = AwaitTurn(large_reads_, guard_.KeyOf(caller, context));
  if (turn.ok() && context.IsCancelled()) return absl::CancelledError("the client has gone");
  return turn;
}

grpc::Status FrameService::GetForces(ServedCall& call, const v1::GetForcesRequest& request,
                                     v1::GetForcesResponse* response) {
  const auto admitted = AdmitToSession(guard_, table_, call.context(), request);
  if (!admitted.ok()) return ToGrpc(admitted.status());
  const auto numbers = static_cast<std::size_t>(admitted->session->model().rest.size());
  if (absl::Status reserved = call.Reserve(2 * sizeof(double) * numbers); !reserved.ok()) return ToGrpc(reserved);
  auto turn = TakeTurn(admitted->caller, call.context(), sizeof(double) * numbers);
  if (!turn.ok()) return ToGrpc(turn.status());
  auto read = session::ReadForces(table_, request);
  if (!read.ok()) return ToGrpc(read.status());
  *response = *std::move(read);
  return grpc::Status::OK;
}

}  // namespace phrenic::service
