#include "server/service/fit_service.h"

#include <string>
#include <string_view>
#include <utility>

#include "server/fit/fit_message.h"
#include "server/fit/fit_request.h"
#include "server/mechanics/stop_check.h"
#include "server/schema/part_of.h"
#include "server/service/calls/status.h"

namespace phrenic::service {
namespace {

// Returns what sends the progress of a fit to its caller, and stops it when the caller has left. Refers to all three.
template <typename Response>
fit::FitProgress ReportTo(grpc::CallbackServerContext& context, ReplyStream<Response>& writer, Response& response) {
  return [&](double done, std::string_view doing) {
    response.mutable_progress()->set_done(done);
    response.mutable_progress()->set_doing(std::string(doing));
    return !context.IsCancelled() && writer.Write(response);
  };
}

}  // namespace

FitService::FitService(session::Models& models, const session::Limits& limits, AccessGuard& guard)
    : models_(models),
      guard_(guard),
      longest_(limits.compile_seconds),
      fits_({"fits", "--max-exports, --max-share", limits.exports, PartOf(limits.exports, limits.share)}) {}

void FitService::AddTo(CallTable& calls) {
  calls.Add(Lane::kWork, *this, &FitService::FitMotion);
  calls.Add(Lane::kWork, *this, &FitService::StudyMotion);
}

absl::StatusOr<fit::SceneLungs> FitService::LungsOf(const v1::SceneSource& source, const access::Caller& caller,
                                                    grpc::CallbackServerContext& context) {
  const auto scene = models_.Resolve(source);
  if (!scene.ok()) return scene.status();
  const auto meshes = models_.MeshesOf(*scene, guard_.RequesterOf(caller, context));
  if (!meshes.ok()) return meshes.status();
  const StopCheck stop([&context] { return context.IsCancelled(); }, longest_, "--max-compile-seconds");
  return fit::MakeSceneLungs(*scene, *meshes, stop);
}

grpc::Status FitService::FitMotion(grpc::CallbackServerContext* context, const v1::FitMotionRequest* request,
                                   ReplyStream<v1::FitMotionResponse>* writer) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  const auto running = fits_.Take(guard_.ShareOf(*caller));
  if (!running.ok()) return ToGrpc(running.status());
  const auto requested = fit::ReadFitRequest(*request);
  if (!requested.ok()) return ToGrpc(requested.status());
  const auto lungs = LungsOf(request->source(), *caller, *context);
  if (!lungs.ok()) return ToGrpc(lungs.status());
  v1::FitMotionResponse response;
  auto result = fit::FitRequested(*requested, *lungs, ReportTo(*context, *writer, response));
  if (!result.ok()) return ToGrpc(result.status());
  *response.mutable_result() = *std::move(result);
  writer->Write(response);
  return grpc::Status::OK;
}

grpc::Status FitService::StudyMotion(grpc::CallbackServerContext* context, const v1::StudyMotionRequest* request,
                                     ReplyStream<v1::StudyMotionResponse>* writer) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  const auto running = fits_.Take(guard_.ShareOf(*caller));
  if (!running.ok()) return ToGrpc(running.status());
  const auto requested = fit::ReadStudyRequest(*request);
  if (!requested.ok()) return ToGrpc(requested.status());
  const auto lungs = LungsOf(request->source(), *caller, *context);
  if (!lungs.ok()) return ToGrpc(lungs.status());
  v1::StudyMotionResponse response;
  const auto study =
      fit::StudyMotion(lungs->templates, requested->cases, requested->options, ReportTo(*context, *writer, response));
  if (!study.ok()) return ToGrpc(study.status());
  for (const fit::StudiedPerson& person : study->people) {
    *response.mutable_person() = fit::PersonMessage(person, requested->options);
    if (!writer->Write(response)) return grpc::Status::OK;  // the client disconnected
  }
  *response.mutable_people() = fit::PeopleMessage(*study);
  writer->Write(response);
  return grpc::Status::OK;
}

}  // namespace phrenic::service
