#include "server/service/server_service.h"

#include "server/service/calls/status.h"

namespace phrenic::service {

void ServerService::AddTo(CallTable& calls) { calls.Add(Lane::kQuick, *this, &ServerService::GetServer); }

grpc::Status ServerService::GetServer(grpc::CallbackServerContext* context, const v1::GetServerRequest* request,
                                      v1::GetServerResponse* response) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  response->set_version(PHRENIC_VERSION);
  response->set_web_port(web_port_);
  response->set_viewer_is_built(viewer_is_built_);
  response->set_has_data_folder(has_data_folder_);
  response->set_encrypted(encrypted_);
  return grpc::Status::OK;
}

}  // namespace phrenic::service
