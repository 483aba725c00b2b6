#include "server/service/control_service.h"

#include <utility>

#include "server/service/calls/session_call.h"
#include "server/service/calls/status.h"

namespace phrenic::service {
namespace {

constexpr double kDefaultPresence = 30;  // [s]

}  // namespace

void ControlService::AddTo(CallTable& calls) {
  calls.Add(Lane::kSession, *this, &ControlService::EnterSession);
  calls.Add(Lane::kSession, *this, &ControlService::TakeControl);
  calls.Add(Lane::kSession, *this, &ControlService::HandControl);
  calls.Add(Lane::kSession, *this, &ControlService::ReleaseControl);
  calls.Add(Lane::kSession, *this, &ControlService::ShowCamera);
}

template <class Request, class Response, class Act>
grpc::Status ControlService::Change(const grpc::CallbackServerContext& context, const Request& request,
                                    Response* response, Act act) {
  const auto call = AdmitToSession(guard_, table_, context, request);
  if (!call.ok()) return ToGrpc(call.status());
  auto control = call->session->ChangeControl(act);
  if (!control.ok()) return ToGrpc(control.status());
  *response->mutable_control() = *std::move(control);
  return grpc::Status::OK;
}

grpc::Status ControlService::EnterSession(grpc::CallbackServerContext* context, const v1::EnterSessionRequest* request,
                                          v1::EnterSessionResponse* response) {
  return Change(*context, *request, response, [&](session::ControlBook& book, absl::Time now) {
    const auto presence = absl::Seconds(request->has_time_to_live() ? request->time_to_live() : kDefaultPresence);
    auto token = book.Enter(request->name(), request->control_token(), presence, now);
    if (token.ok()) response->set_control_token(*token);
    return token.status();
  });
}

grpc::Status ControlService::TakeControl(grpc::CallbackServerContext* context, const v1::TakeControlRequest* request,
                                         v1::TakeControlResponse* response) {
  return Change(*context, *request, response, [&](session::ControlBook& book, absl::Time now) {
    const auto granted = book.Take(request->control_token(), now);
    if (granted.ok()) response->set_granted(*granted);
    return granted.status();
  });
}

grpc::Status ControlService::HandControl(grpc::CallbackServerContext* context, const v1::HandControlRequest* request,
                                         v1::HandControlResponse* response) {
  return Change(*context, *request, response, [&](session::ControlBook& book, absl::Time now) -> absl::Status {
    if (request->everybody()) return book.HandToEverybody(request->control_token(), now);
    if (!request->name().empty()) return book.Hand(request->control_token(), request->name(), now);
    return absl::InvalidArgumentError("to: name who gets control, or set everybody");
  });
}

grpc::Status ControlService::ReleaseControl(grpc::CallbackServerContext* context,
                                            const v1::ReleaseControlRequest* request,
                                            v1::ReleaseControlResponse* response) {
  return Change(*context, *request, response, [&](session::ControlBook& book, absl::Time now) {
    return book.Release(request->control_token(), now);
  });
}

grpc::Status ControlService::ShowCamera(grpc::CallbackServerContext* context, const v1::ShowCameraRequest* request,
                                        v1::ShowCameraResponse* /*response*/) {
  const auto call = AdmitToSession(guard_, table_, *context, *request);
  if (!call.ok()) return ToGrpc(call.status());
  return ToGrpc(call->session->ShowCamera(request->camera(), request->control_token()));
}

}  // namespace phrenic::service
