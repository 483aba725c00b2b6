// v1.ControlService: who may change a session.
#ifndef PHRENIC_SERVER_SERVICE_CONTROL_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_CONTROL_SERVICE_H_

#include "phrenic/v1/control.pb.h"
#include "server/service/calls/access_guard.h"
#include "server/service/calls/call_table.h"
#include "server/session/table.h"

namespace phrenic::service {

// Thread-safe: the methods run on threads of their lanes. Errors as in the proto of each method.
class ControlService final {
 public:
  explicit ControlService(session::Table& table, AccessGuard& guard) : table_(table), guard_(guard) {}

  // Adds the methods to the table. The service outlives it.
  void AddTo(CallTable& calls);

  grpc::Status EnterSession(grpc::CallbackServerContext* context, const v1::EnterSessionRequest* request,
                            v1::EnterSessionResponse* response);
  grpc::Status TakeControl(grpc::CallbackServerContext* context, const v1::TakeControlRequest* request,
                           v1::TakeControlResponse* response);
  grpc::Status HandControl(grpc::CallbackServerContext* context, const v1::HandControlRequest* request,
                           v1::HandControlResponse* response);
  grpc::Status ReleaseControl(grpc::CallbackServerContext* context, const v1::ReleaseControlRequest* request,
                              v1::ReleaseControlResponse* response);
  grpc::Status ShowCamera(grpc::CallbackServerContext* context, const v1::ShowCameraRequest* request,
                          v1::ShowCameraResponse* response);

 private:
  // Admits the call, applies `act` to the session's ControlBook, and returns the new control state.
  template <class Request, class Response, class Act>
  grpc::Status Change(const grpc::CallbackServerContext& context, const Request& request, Response* response, Act act);

  session::Table& table_;
  AccessGuard& guard_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_CONTROL_SERVICE_H_
