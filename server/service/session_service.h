// Sessions over gRPC: validates, finds the session, and has it do what was asked.
#ifndef PHRENIC_SERVER_SERVICE_SESSION_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_SESSION_SERVICE_H_

#include "phrenic/v1/session.grpc.pb.h"
#include "server/service/calls/access_guard.h"
#include "server/session/table.h"

namespace phrenic::service {

// gRPC's threads call, any number at a time.
class SessionService final : public v1::SessionService::Service {
 public:
  explicit SessionService(session::Table& table, AccessGuard& guard) : table_(table), guard_(guard) {}

  grpc::Status CreateSession(grpc::ServerContext* context, const v1::CreateSessionRequest* request,
                             v1::CreateSessionResponse* response) override;
  grpc::Status GetSession(grpc::ServerContext* context, const v1::GetSessionRequest* request,
                          v1::GetSessionResponse* response) override;
  grpc::Status ForkSession(grpc::ServerContext* context, const v1::ForkSessionRequest* request,
                           v1::ForkSessionResponse* response) override;
  grpc::Status ListSessions(grpc::ServerContext* context, const v1::ListSessionsRequest* request,
                            v1::ListSessionsResponse* response) override;
  grpc::Status DeleteSession(grpc::ServerContext* context, const v1::DeleteSessionRequest* request,
                             v1::DeleteSessionResponse* response) override;
  grpc::Status PlaySession(grpc::ServerContext* context, const v1::PlaySessionRequest* request,
                           v1::PlaySessionResponse* response) override;
  grpc::Status PauseSession(grpc::ServerContext* context, const v1::PauseSessionRequest* request,
                            v1::PauseSessionResponse* response) override;
  grpc::Status StepSession(grpc::ServerContext* context, const v1::StepSessionRequest* request,
                           v1::StepSessionResponse* response) override;
  grpc::Status ResetSession(grpc::ServerContext* context, const v1::ResetSessionRequest* request,
                            v1::ResetSessionResponse* response) override;
  grpc::Status UpdateParameters(grpc::ServerContext* context, const v1::UpdateParametersRequest* request,
                                v1::UpdateParametersResponse* response) override;
  grpc::Status PullSession(grpc::ServerContext* context, const v1::PullSessionRequest* request,
                           v1::PullSessionResponse* response) override;

 private:
  template <class Request, class Response, class Act>
  grpc::Status Change(const grpc::ServerContext& context, const Request& request, Response* response, Act act);

  session::Table& table_;
  AccessGuard& guard_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_SESSION_SERVICE_H_
