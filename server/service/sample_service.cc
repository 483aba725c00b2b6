#include "server/service/sample_service.h"

#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/schema/part_of.h"
#include "server/service/calls/messages.h"
#include "server/service/calls/session_call.h"
#include "server/service/calls/status.h"
#include "server/service/sample_reactor.h"

namespace phrenic::service {
namespace {

// How long sampling goes on after a read: a browser's hidden page may call once a minute.
constexpr absl::Duration kAfterRead = absl::Seconds(75);

template <class Request>
absl::StatusOr<SampleSelection> SelectionOf(const stream::Sampler& sampler, const Request& request) {
  auto selection = SelectSamples(sampler, request.measures(), request.probes());
  if (selection.ok() && request.has_interval()) selection->interval = request.interval();
  return selection;
}

}  // namespace

SampleService::SampleService(session::Table& table, AccessGuard& guard, const session::Limits& limits)
    : table_(table),
      guard_(guard),
      readers_({"streams of samples", "--max-viewers-in-all, --max-share", limits.viewers_in_all,
                PartOf(limits.viewers_in_all, limits.share)}),
      seats_({"streams of samples of this session", "--max-viewers", std::numeric_limits<int>::max(), limits.viewers}) {
}

void SampleService::AddTo(CallTable& calls) {
  calls.AddRaw<v1::WatchSamplesRequest>(Lane::kSession, [this](ServedCall& call) -> std::optional<grpc::Status> {
    if (absl::Status watched = WatchSamples(call); !watched.ok()) return ToGrpc(watched);
    return std::nullopt;
  });
  calls.Add(Lane::kSession, *this, &SampleService::ReadSamples);
}

absl::StatusOr<FairShare::Hold> SampleService::TakeSeats(const access::Caller& caller, const std::string& session) {
  auto reader = readers_.Take(guard_.ShareOf(caller));
  if (!reader.ok()) return reader;
  auto seat = seats_.Take(session);
  if (!seat.ok()) return seat;
  return std::make_shared<std::pair<FairShare::Hold, FairShare::Hold>>(*std::move(reader), *std::move(seat));
}

absl::Status SampleService::WatchSamples(ServedCall& call) {
  v1::WatchSamplesRequest request;
  if (absl::Status parsed = Parse(call.request(), request); !parsed.ok()) return parsed;
  auto admitted = AdmitToSession(guard_, table_, call.context(), request);
  if (!admitted.ok()) return admitted.status();
  auto selection = SelectionOf(admitted->session->sampler(), request);
  if (!selection.ok()) return selection.status();
  auto seats = TakeSeats(admitted->caller, request.session_id());
  if (!seats.ok()) return seats.status();
  auto may_see = guard_.StillMaySee(admitted->caller, *admitted->session);
  auto reader =
      SampleReader::Open(std::move(admitted->session), *std::move(selection), {request.track(), request.last()},
                         SampleReactor::kKept, [] { return absl::OkStatus(); });
  if (!reader.ok()) return reader.status();
  std::make_shared<SampleReactor>(call, *std::move(reader),
                                  SampleReactor::Subscription{*std::move(seats), std::move(may_see)})
      ->Start();
  return absl::OkStatus();
}

grpc::Status SampleService::ReadSamples(grpc::CallbackServerContext* context, const v1::ReadSamplesRequest* request,
                                        v1::ReadSamplesResponse* response) {
  auto call = AdmitToSession(guard_, table_, *context, *request);
  if (!call.ok()) return ToGrpc(call.status());
  auto selection = SelectionOf(call->session->sampler(), *request);
  if (!selection.ok()) return ToGrpc(selection.status());
  auto reader = SampleReader::Open(std::move(call->session), *std::move(selection), {request->track(), request->last()},
                                   kAfterRead, [&] { return guard_.CountCall(call->caller); });
  if (!reader.ok()) return ToGrpc(reader.status());
  auto read = reader->Next();
  if (!read.ok()) return ToGrpc(read.status());
  *response = *std::move(read);
  return grpc::Status::OK;
}

}  // namespace phrenic::service
