// v1.SceneService: the scene catalogue, and the report of compiling a scene.
#ifndef PHRENIC_SERVER_SERVICE_SCENE_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_SCENE_SERVICE_H_

#include "phrenic/v1/session.grpc.pb.h"
#include "server/service/calls/access_guard.h"
#include "server/session/models.h"

namespace phrenic::service {

// Thread-safe: gRPC calls the methods on its own threads. Errors as in the proto of each method.
class SceneService final : public v1::SceneService::Service {
 public:
  SceneService(session::Models& models, AccessGuard& guard) : models_(models), guard_(guard) {}

  grpc::Status ListScenes(grpc::ServerContext* context, const v1::ListScenesRequest* request,
                          v1::ListScenesResponse* response) override;
  grpc::Status DescribeScene(grpc::ServerContext* context, const v1::DescribeSceneRequest* request,
                             v1::DescribeSceneResponse* response) override;

 private:
  session::Models& models_;
  AccessGuard& guard_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_SCENE_SERVICE_H_
