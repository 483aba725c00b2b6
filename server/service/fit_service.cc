#include "server/service/fit_service.h"

#include <string>
#include <string_view>
#include <utility>

#include "server/fit/fit_request.h"
#include "server/mechanics/stop_check.h"
#include "server/schema/part_of.h"
#include "server/service/calls/status.h"

namespace phrenic::service {

FitService::FitService(session::Models& models, const session::Limits& limits, AccessGuard& guard)
    : models_(models),
      guard_(guard),
      longest_(limits.compile_seconds),
      fits_({"fits", "--max-exports, --max-share", limits.exports, PartOf(limits.exports, limits.share)}) {}

void FitService::AddTo(CallTable& calls) { calls.Add(Lane::kWork, *this, &FitService::FitMotion); }

grpc::Status FitService::FitMotion(grpc::CallbackServerContext* context, const v1::FitMotionRequest* request,
                                   ReplyStream<v1::FitMotionResponse>* writer) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  const auto running = fits_.Take(guard_.ShareOf(*caller));
  if (!running.ok()) return ToGrpc(running.status());
  const auto requested = fit::ReadFitRequest(*request);
  if (!requested.ok()) return ToGrpc(requested.status());
  const auto scene = models_.Resolve(request->source());
  if (!scene.ok()) return ToGrpc(scene.status());
  const auto meshes = models_.MeshesOf(*scene, guard_.RequesterOf(*caller, *context));
  if (!meshes.ok()) return ToGrpc(meshes.status());
  const StopCheck stop([context] { return context->IsCancelled(); }, longest_, "--max-compile-seconds");
  const auto lungs = fit::MakeSceneLungs(*scene, *meshes, stop);
  if (!lungs.ok()) return ToGrpc(lungs.status());
  v1::FitMotionResponse response;
  auto result = fit::FitRequested(*requested, *lungs, [&](double done, std::string_view doing) {
    response.mutable_progress()->set_done(done);
    response.mutable_progress()->set_doing(std::string(doing));
    return !context->IsCancelled() && writer->Write(response);
  });
  if (!result.ok()) return ToGrpc(result.status());
  *response.mutable_result() = *std::move(result);
  writer->Write(response);
  return grpc::Status::OK;
}

}  // namespace phrenic::service
