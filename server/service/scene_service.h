// v1.SceneService: the scene catalogue, and the report of compiling a scene.
#ifndef PHRENIC_SERVER_SERVICE_SCENE_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_SCENE_SERVICE_H_

#include "phrenic/v1/session.pb.h"
#include "server/service/calls/access_guard.h"
#include "server/service/calls/call_table.h"
#include "server/session/models.h"

namespace phrenic::service {

// Thread-safe: the methods run on threads of their lanes. Errors as in the proto of each method.
class SceneService final {
 public:
  SceneService(session::Models& models, AccessGuard& guard) : models_(models), guard_(guard) {}

  // Adds the methods to the table. The service outlives it.
  void AddTo(CallTable& calls);

  grpc::Status ListScenes(grpc::CallbackServerContext* context, const v1::ListScenesRequest* request,
                          v1::ListScenesResponse* response);
  grpc::Status DescribeScene(grpc::CallbackServerContext* context, const v1::DescribeSceneRequest* request,
                             v1::DescribeSceneResponse* response);

 private:
  session::Models& models_;
  AccessGuard& guard_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_SCENE_SERVICE_H_
