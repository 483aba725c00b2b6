#include "server/service/session_service.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "server/mechanics/presets.h"
#include "server/schema/schema.h"
#include "server/service/status.h"

namespace phrenic::service {
namespace {

// The session that a request names, when the request is in order.
template <class Request>
absl::StatusOr<std::shared_ptr<session::Session>> Find(const session::Table& table, const Request& request) {
  if (absl::Status status = schema::Validate(request); !status.ok()) return status;
  return table.Find(request.session_id());
}

template <class Response>
grpc::Status Answer(absl::StatusOr<v1::Session> session, Response* response) {
  if (!session.ok()) return ToGrpc(session.status());
  *response->mutable_session() = *std::move(session);
  return grpc::Status::OK;
}

}  // namespace

grpc::Status SessionService::CreateSession(grpc::ServerContext* /*context*/, const v1::CreateSessionRequest* request,
                                           v1::CreateSessionResponse* response) {
  if (absl::Status status = schema::Validate(*request); !status.ok()) return ToGrpc(status);
  const auto session = table_.Create(*request);
  if (!session.ok()) return ToGrpc(session.status());
  return Answer((*session)->status(), response);
}

grpc::Status SessionService::GetSession(grpc::ServerContext* /*context*/, const v1::GetSessionRequest* request,
                                        v1::GetSessionResponse* response) {
  const auto session = Find(table_, *request);
  if (!session.ok()) return ToGrpc(session.status());
  *response->mutable_report() = (*session)->model().report;
  return Answer((*session)->status(), response);
}

grpc::Status SessionService::ForkSession(grpc::ServerContext* /*context*/, const v1::ForkSessionRequest* request,
                                         v1::ForkSessionResponse* response) {
  if (absl::Status status = schema::Validate(*request); !status.ok()) return ToGrpc(status);
  const auto fork = table_.Fork(*request);
  if (!fork.ok()) return ToGrpc(fork.status());
  return Answer((*fork)->status(), response);
}

grpc::Status SessionService::ListSessions(grpc::ServerContext* /*context*/, const v1::ListSessionsRequest* request,
                                          v1::ListSessionsResponse* response) {
  if (request->page_size() < 0 || request->page_size() > 1000) {
    return ToGrpc(
        absl::InvalidArgumentError(absl::StrCat("page_size: ", request->page_size(), " is outside 0 to 1000")));
  }
  session::Table::Page page = table_.List(request->page_size(), request->page_token());
  for (const auto& session : page.sessions) *response->add_sessions() = session->status();
  response->set_next_page_token(std::move(page.next_token));
  return grpc::Status::OK;
}

grpc::Status SessionService::DeleteSession(grpc::ServerContext* /*context*/, const v1::DeleteSessionRequest* request,
                                           v1::DeleteSessionResponse* /*response*/) {
  if (absl::Status status = schema::Validate(*request); !status.ok()) return ToGrpc(status);
  return ToGrpc(table_.Delete(request->session_id()));
}

grpc::Status SessionService::PlaySession(grpc::ServerContext* /*context*/, const v1::PlaySessionRequest* request,
                                         v1::PlaySessionResponse* response) {
  const auto session = Find(table_, *request);
  if (!session.ok()) return ToGrpc(session.status());
  const auto speed = request->has_speed() ? std::optional(request->speed()) : std::nullopt;
  return Answer((*session)->Play(speed, request->as_fast_as_possible(), request->until_time()), response);
}

grpc::Status SessionService::PauseSession(grpc::ServerContext* /*context*/, const v1::PauseSessionRequest* request,
                                          v1::PauseSessionResponse* response) {
  const auto session = Find(table_, *request);
  if (!session.ok()) return ToGrpc(session.status());
  return Answer((*session)->Pause(), response);
}

grpc::Status SessionService::StepSession(grpc::ServerContext* context, const v1::StepSessionRequest* request,
                                         v1::StepSessionResponse* response) {
  const auto session = Find(table_, *request);
  if (!session.ok()) return ToGrpc(session.status());
  const auto tick = request->has_expected_tick() ? std::optional<std::int64_t>(request->expected_tick()) : std::nullopt;
  auto stepped = (*session)->Step(request->ticks(), tick, [&] { return context->IsCancelled(); });
  if (!stepped.ok()) return ToGrpc(stepped.status());
  response->set_state_hash(std::move(stepped->state_hash));
  *response->mutable_measures() = std::move(stepped->measures);
  return Answer(std::move(stepped->session), response);
}

grpc::Status SessionService::ResetSession(grpc::ServerContext* /*context*/, const v1::ResetSessionRequest* request,
                                          v1::ResetSessionResponse* response) {
  const auto session = Find(table_, *request);
  if (!session.ok()) return ToGrpc(session.status());
  return Answer((*session)->Reset(), response);
}

grpc::Status SessionService::UpdateParameters(grpc::ServerContext* /*context*/,
                                              const v1::UpdateParametersRequest* request,
                                              v1::UpdateParametersResponse* response) {
  const auto session = Find(table_, *request);
  if (!session.ok()) return ToGrpc(session.status());
  const auto revision =
      request->has_expected_revision() ? std::optional<std::int64_t>(request->expected_revision()) : std::nullopt;
  auto changes = FindPreset((*session)->model().scene, request->preset());
  if (!changes.ok()) return ToGrpc(changes.status());
  changes->MergeFrom(request->parameters());
  auto updated = (*session)->Update(*changes, revision);
  if (!updated.ok()) return ToGrpc(updated.status());
  for (std::string& warning : updated->warnings) response->add_warnings(std::move(warning));
  return Answer(std::move(updated->session), response);
}

grpc::Status SessionService::PullSession(grpc::ServerContext* /*context*/, const v1::PullSessionRequest* request,
                                         v1::PullSessionResponse* response) {
  const auto session = Find(table_, *request);
  if (!session.ok()) return ToGrpc(session.status());
  if (request->pulls().empty() && !request->release_others()) {
    return ToGrpc(absl::InvalidArgumentError("pulls: there is none; name one, or set release_others to let go of all"));
  }
  return Answer((*session)->Pull(request->pulls(), request->release_others()), response);
}

}  // namespace phrenic::service
