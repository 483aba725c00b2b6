// v1.SceneService: the scene catalogue, and the report of compiling a scene.
#ifndef PHRENIC_SERVER_SERVICE_SCENE_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_SCENE_SERVICE_H_

#include "phrenic/v1/session.pb.h"
#include "server/service/calls/access_guard.h"
#include "server/service/calls/call_table.h"
#include "server/session/models.h"

namespace phrenic::service {

// Thread-safe: the methods run on threads of their lanes. Errors as in the proto of each method. session::Models
// compiles scenes and keeps them; the service has no state and no lock.
class SceneService final {
 public:
  // Both outlive the service.
  SceneService(session::Models& models, AccessGuard& guard) : models_(models), guard_(guard) {}

  // Adds the methods to the table. The service outlives it.
  void AddTo(CallTable& calls);

  // On Lane::kQuick. Reads the scenes' folders at each call, so an edited scene is listed as it is now. A scene that
  // cannot be read has the error as its description.
  grpc::Status ListScenes(grpc::CallbackServerContext* context, const v1::ListScenesRequest* request,
                          v1::ListScenesResponse* response);
  // On Lane::kWork, for as long as the compile takes. The compiled model is kept for the next session of the same
  // scene. CANCELLED if the caller disconnects, RESOURCE_EXHAUSTED for a scene that is too large.
  grpc::Status DescribeScene(grpc::CallbackServerContext* context, const v1::DescribeSceneRequest* request,
                             v1::DescribeSceneResponse* response);

 private:
  session::Models& models_;
  AccessGuard& guard_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_SCENE_SERVICE_H_
