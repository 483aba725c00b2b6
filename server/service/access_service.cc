#include "server/service/access_service.h"

#include "absl/strings/str_cat.h"
#include "google/protobuf/util/time_util.h"
#include "server/crypto/secret.h"
#include "server/crypto/sha256.h"
#include "server/service/calls/session_call.h"
#include "server/service/calls/status.h"

namespace phrenic::service {
namespace {

using session::ControlState;

constexpr double kDefaultLinkTime = 7 * 24 * 3600;  // [s]
constexpr std::size_t kIdLength = 8;

void FillLink(const ControlState::Link& link, v1::JoinLink& filled) {
  filled.set_id(link.id);
  filled.set_role(link.role);
  filled.set_made_by(link.made_by);
  *filled.mutable_expire_time() =
      google::protobuf::util::TimeUtil::NanosecondsToTimestamp(absl::ToUnixNanos(link.expires));
}

// Returns a new join link and its secret, of which the link has only the hash.
std::pair<ControlState::Link, std::string> NewLink(const v1::CreateLinkRequest& request, const access::Caller& caller) {
  std::string secret = NewToken();
  const double lifetime = request.has_time_to_live() ? request.time_to_live() : kDefaultLinkTime;
  const auto role = request.role() == v1::ACCESS_ROLE_UNSPECIFIED ? v1::ACCESS_ROLE_VIEWER : request.role();
  ControlState::Link link{NewToken().substr(0, kIdLength), Sha256Hex(secret), role,
                          absl::Now() + absl::Seconds(lifetime), caller.id()};
  return {std::move(link), std::move(secret)};
}

}  // namespace

void AccessService::AddTo(CallTable& calls) {
  calls.Add(Lane::kQuick, *this, &AccessService::GetAccess);
  calls.Add(Lane::kSession, *this, &AccessService::CreateLink);
  calls.Add(Lane::kQuick, *this, &AccessService::ListLinks);
  calls.Add(Lane::kSession, *this, &AccessService::RevokeLink);
}

absl::Status AccessService::CheckGuarded() const {
  if (guard_.guarded()) return absl::OkStatus();
  return absl::FailedPreconditionError(
      "the server has no accounts, and every caller sees every session: share the address with ?session=ID, or start "
      "the server with --tokens FILE to have links that expire");
}

grpc::Status AccessService::GetAccess(grpc::CallbackServerContext* context, const v1::GetAccessRequest* request,
                                      v1::GetAccessResponse* response) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  response->set_accounts(guard_.guarded());
  response->set_name(caller->account.name);
  response->set_role(caller->account.role);
  return grpc::Status::OK;
}

grpc::Status AccessService::CreateLink(grpc::CallbackServerContext* context, const v1::CreateLinkRequest* request,
                                       v1::CreateLinkResponse* response) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  if (absl::Status status = CheckGuarded(); !status.ok()) return ToGrpc(status);
  if (request->role() > v1::ACCESS_ROLE_CONTROLLER) {
    return ToGrpc(absl::InvalidArgumentError("role: must be viewer or controller for a link"));
  }
  const auto session = table_.Find(request->session_id());
  if (!session.ok()) return ToGrpc(session.status());
  auto [link, secret] = NewLink(*request, *caller);
  FillLink(link, *response->mutable_link());
  const auto changed = (*session)->ChangeControl(
      [&link = link](session::ControlBook& book, absl::Time now) { return book.AddLink(std::move(link), now); });
  if (changed.ok()) response->set_secret(secret);
  return ToGrpc(changed.status());
}

grpc::Status AccessService::ListLinks(grpc::CallbackServerContext* context, const v1::ListLinksRequest* request,
                                      v1::ListLinksResponse* response) {
  const auto call = AdmitToSession(guard_, table_, *context, *request);
  if (!call.ok()) return ToGrpc(call.status());
  const auto access = call->session->access();
  for (const ControlState::Link& link : access->links) {
    if (absl::Now() < link.expires) FillLink(link, *response->add_links());
  }
  return grpc::Status::OK;
}

grpc::Status AccessService::RevokeLink(grpc::CallbackServerContext* context, const v1::RevokeLinkRequest* request,
                                       v1::RevokeLinkResponse* /*response*/) {
  const auto call = AdmitToSession(guard_, table_, *context, *request);
  if (!call.ok()) return ToGrpc(call.status());
  const auto changed = call->session->ChangeControl(
      [&](session::ControlBook& book, absl::Time) { return book.RemoveLink(request->link_id()); });
  return ToGrpc(changed.status());
}

}  // namespace phrenic::service
