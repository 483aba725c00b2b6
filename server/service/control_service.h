// v1.ControlService: who may change a session.
#ifndef PHRENIC_SERVER_SERVICE_CONTROL_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_CONTROL_SERVICE_H_

#include "phrenic/v1/control.pb.h"
#include "server/service/calls/access_guard.h"
#include "server/service/calls/call_table.h"
#include "server/session/table.h"

namespace phrenic::service {

// Thread-safe: the methods run on threads of their lanes. Errors as in the proto of each method.
//
// Each session keeps its own ControlBook, which its stepping thread changes between two steps; the service has no state
// and no lock. All methods are on Lane::kSession, since they wait for that.
class ControlService final {
 public:
  // Both outlive the service.
  explicit ControlService(session::Table& table, AccessGuard& guard) : table_(table), guard_(guard) {}

  // Adds the methods to the table. The service outlives it.
  void AddTo(CallTable& calls);

  // A stay lasts 30 s unless the request says otherwise [s]; a client renews it by another call. RESOURCE_EXHAUSTED for
  // more than 256 participants.
  grpc::Status EnterSession(grpc::CallbackServerContext* context, const v1::EnterSessionRequest* request,
                            v1::EnterSessionResponse* response);
  // `granted` is false if the request for control waits for the controller.
  grpc::Status TakeControl(grpc::CallbackServerContext* context, const v1::TakeControlRequest* request,
                           v1::TakeControlResponse* response);
  // INVALID_ARGUMENT if the request names neither a participant nor everybody; FAILED_PRECONDITION if no one has
  // entered under the name.
  grpc::Status HandControl(grpc::CallbackServerContext* context, const v1::HandControlRequest* request,
                           v1::HandControlResponse* response);
  grpc::Status ReleaseControl(grpc::CallbackServerContext* context, const v1::ReleaseControlRequest* request,
                              v1::ReleaseControlResponse* response);
  // PERMISSION_DENIED unless the caller controls the session. Not saved.
  grpc::Status ShowCamera(grpc::CallbackServerContext* context, const v1::ShowCameraRequest* request,
                          v1::ShowCameraResponse* response);

 private:
  // Admits the call, applies `act` to the session's ControlBook, and returns the new control state. Returns the errors
  // of AdmitToSession, of `act` and of Session::ChangeControl.
  template <class Request, class Response, class Act>
  grpc::Status Change(const grpc::CallbackServerContext& context, const Request& request, Response* response, Act act);

  session::Table& table_;
  AccessGuard& guard_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_CONTROL_SERVICE_H_
