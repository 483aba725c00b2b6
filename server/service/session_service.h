// v1.SessionService: creates sessions, lists them and changes their state.
#ifndef PHRENIC_SERVER_SERVICE_SESSION_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_SESSION_SERVICE_H_

#include "phrenic/v1/session.grpc.pb.h"
#include "server/service/calls/access_guard.h"
#include "server/service/calls/page_tokens.h"
#include "server/session/table.h"

namespace phrenic::service {

// Thread-safe: gRPC calls the methods on its own threads. Errors as in the proto of each method.
class SessionService final : public v1::SessionService::Service {
 public:
  // All outlive the service.
  SessionService(session::Table& table, AccessGuard& guard, const PageTokens& page_tokens)
      : table_(table), guard_(guard), page_tokens_(page_tokens) {}

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
  // Admits the call, has `make` add a session with its ControlBook to the table, and returns the session's status.
  template <class Request, class Response, class Make>
  grpc::Status Add(const grpc::ServerContext& context, const Request& request, Response* response, Make make);
  // Admits the call and applies `act` to its session, once per request_id.
  template <class Request, class Response, class Act>
  grpc::Status Change(const grpc::ServerContext& context, const Request& request, Response* response, Act act);

  session::Table& table_;
  AccessGuard& guard_;
  const PageTokens& page_tokens_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_SESSION_SERVICE_H_
