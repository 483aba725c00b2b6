#include "server/service/scene_service.h"

#include "server/service/calls/status.h"

namespace phrenic::service {

void SceneService::AddTo(CallTable& calls) {
  calls.Add(Lane::kQuick, *this, &SceneService::ListScenes);
  calls.Add(Lane::kWork, *this, &SceneService::DescribeScene);
}

grpc::Status SceneService::ListScenes(grpc::CallbackServerContext* context, const v1::ListScenesRequest* request,
                                      v1::ListScenesResponse* response) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  for (v1::SceneSummary& summary : models_.catalogue().List()) *response->add_scenes() = std::move(summary);
  return grpc::Status::OK;
}

grpc::Status SceneService::DescribeScene(grpc::CallbackServerContext* context, const v1::DescribeSceneRequest* request,
                                         v1::DescribeSceneResponse* response) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  const auto model = models_.Get(request->source(), guard_.RequesterOf(*caller, *context));
  if (!model.ok()) return ToGrpc(model.status());
  *response->mutable_scene() = (*model)->scene;
  *response->mutable_report() = (*model)->report;
  *response->mutable_parameters() = (*model)->parameters;
  return grpc::Status::OK;
}

}  // namespace phrenic::service
