// Who may change a session, over gRPC.
#ifndef PHRENIC_SERVER_SERVICE_CONTROL_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_CONTROL_SERVICE_H_

#include "phrenic/v1/control.grpc.pb.h"
#include "server/service/calls/access_guard.h"
#include "server/session/table.h"

namespace phrenic::service {

// gRPC's threads call, any number at a time.
class ControlService final : public v1::ControlService::Service {
 public:
  explicit ControlService(session::Table& table, AccessGuard& guard) : table_(table), guard_(guard) {}

  grpc::Status EnterSession(grpc::ServerContext* context, const v1::EnterSessionRequest* request,
                            v1::EnterSessionResponse* response) override;
  grpc::Status TakeControl(grpc::ServerContext* context, const v1::TakeControlRequest* request,
                           v1::TakeControlResponse* response) override;
  grpc::Status HandControl(grpc::ServerContext* context, const v1::HandControlRequest* request,
                           v1::HandControlResponse* response) override;
  grpc::Status ReleaseControl(grpc::ServerContext* context, const v1::ReleaseControlRequest* request,
                              v1::ReleaseControlResponse* response) override;
  grpc::Status ShowCamera(grpc::ServerContext* context, const v1::ShowCameraRequest* request,
                          v1::ShowCameraResponse* response) override;

 private:
  // Has `act` change who controls the session that the request names, and writes down who does then.
  template <class Request, class Response, class Act>
  grpc::Status Change(const grpc::ServerContext& context, const Request& request, Response* response, Act act);

  session::Table& table_;
  AccessGuard& guard_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_CONTROL_SERVICE_H_
