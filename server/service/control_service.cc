#include "server/service/control_service.h"

#include <utility>

#include "server/service/calls/status.h"

namespace phrenic::service {
namespace {

constexpr double kUsualStay = 30;  // [s]

}  // namespace

template <class Request, class Response, class Act>
grpc::Status ControlService::Change(const grpc::ServerContext& context, const Request& request, Response* response,
                                    Act act) {
  const auto caller = guard_.Admit(context, request);
  if (!caller.ok()) return ToGrpc(caller.status());
  const auto session = table_.Find(request.session_id());
  if (!session.ok()) return ToGrpc(session.status());
  auto control = (*session)->ChangeControl(act);
  if (!control.ok()) return ToGrpc(control.status());
  *response->mutable_control() = *std::move(control);
  return grpc::Status::OK;
}

grpc::Status ControlService::EnterSession(grpc::ServerContext* context, const v1::EnterSessionRequest* request,
                                          v1::EnterSessionResponse* response) {
  return Change(*context, *request, response, [&](session::ControlBook& book, absl::Time now) {
    const auto stay = absl::Seconds(request->has_time_to_live() ? request->time_to_live() : kUsualStay);
    auto token = book.Enter(request->name(), request->control_token(), stay, now);
    if (token.ok()) response->set_control_token(*token);
    return token.status();
  });
}

grpc::Status ControlService::TakeControl(grpc::ServerContext* context, const v1::TakeControlRequest* request,
                                         v1::TakeControlResponse* response) {
  return Change(*context, *request, response, [&](session::ControlBook& book, absl::Time now) {
    const auto granted = book.Take(request->control_token(), now);
    if (granted.ok()) response->set_granted(*granted);
    return granted.status();
  });
}

grpc::Status ControlService::HandControl(grpc::ServerContext* context, const v1::HandControlRequest* request,
                                         v1::HandControlResponse* response) {
  return Change(*context, *request, response, [&](session::ControlBook& book, absl::Time now) -> absl::Status {
    if (request->everybody()) return book.HandToEverybody(request->control_token(), now);
    if (!request->name().empty()) return book.Hand(request->control_token(), request->name(), now);
    return absl::InvalidArgumentError("to: say to whom control goes: a name, or everybody");
  });
}

grpc::Status ControlService::ReleaseControl(grpc::ServerContext* context, const v1::ReleaseControlRequest* request,
                                            v1::ReleaseControlResponse* response) {
  return Change(*context, *request, response, [&](session::ControlBook& book, absl::Time now) {
    return book.Release(request->control_token(), now);
  });
}

grpc::Status ControlService::ShowCamera(grpc::ServerContext* context, const v1::ShowCameraRequest* request,
                                        v1::ShowCameraResponse* /*response*/) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  const auto session = table_.Find(request->session_id());
  if (!session.ok()) return ToGrpc(session.status());
  return ToGrpc((*session)->ShowCamera(request->camera(), request->control_token()));
}

}  // namespace phrenic::service
