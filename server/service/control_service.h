// v1.ControlService: who may change a session.
#ifndef PHRENIC_SERVER_SERVICE_CONTROL_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_CONTROL_SERVICE_H_

#include "phrenic/v1/control.grpc.pb.h"
#include "server/service/calls/access_guard.h"
#include "server/session/table.h"

namespace phrenic::service {

// Thread-safe: gRPC calls the methods on its own threads. Errors as in the proto of each method.
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
  // Admits the call, applies `act` to the session's ControlBook, and returns the new control state.
  template <class Request, class Response, class Act>
  grpc::Status Change(const grpc::ServerContext& context, const Request& request, Response* response, Act act);

  session::Table& table_;
  AccessGuard& guard_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_CONTROL_SERVICE_H_
