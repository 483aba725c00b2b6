// v1.SessionService: creates sessions, lists them and changes their state.
#ifndef PHRENIC_SERVER_SERVICE_SESSION_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_SESSION_SERVICE_H_

#include "phrenic/v1/session.pb.h"
#include "server/service/calls/access_guard.h"
#include "server/service/calls/call_table.h"
#include "server/service/calls/page_tokens.h"
#include "server/session/table.h"

namespace phrenic::service {

// Thread-safe: the methods run on threads of their lanes. Errors as in the proto of each method.
class SessionService final {
 public:
  // All outlive the service.
  SessionService(session::Table& table, AccessGuard& guard, const PageTokens& page_tokens)
      : table_(table), guard_(guard), page_tokens_(page_tokens) {}

  // Adds the methods to the table. The service outlives it.
  void AddTo(CallTable& calls);

  grpc::Status CreateSession(grpc::CallbackServerContext* context, const v1::CreateSessionRequest* request,
                             v1::CreateSessionResponse* response);
  grpc::Status GetSession(grpc::CallbackServerContext* context, const v1::GetSessionRequest* request,
                          v1::GetSessionResponse* response);
  grpc::Status ForkSession(grpc::CallbackServerContext* context, const v1::ForkSessionRequest* request,
                           v1::ForkSessionResponse* response);
  grpc::Status ListSessions(grpc::CallbackServerContext* context, const v1::ListSessionsRequest* request,
                            v1::ListSessionsResponse* response);
  grpc::Status DeleteSession(grpc::CallbackServerContext* context, const v1::DeleteSessionRequest* request,
                             v1::DeleteSessionResponse* response);
  grpc::Status PlaySession(grpc::CallbackServerContext* context, const v1::PlaySessionRequest* request,
                           v1::PlaySessionResponse* response);
  grpc::Status PauseSession(grpc::CallbackServerContext* context, const v1::PauseSessionRequest* request,
                            v1::PauseSessionResponse* response);
  grpc::Status StepSession(grpc::CallbackServerContext* context, const v1::StepSessionRequest* request,
                           v1::StepSessionResponse* response);
  grpc::Status ResetSession(grpc::CallbackServerContext* context, const v1::ResetSessionRequest* request,
                            v1::ResetSessionResponse* response);
  grpc::Status UpdateParameters(grpc::CallbackServerContext* context, const v1::UpdateParametersRequest* request,
                                v1::UpdateParametersResponse* response);
  grpc::Status PullSession(grpc::CallbackServerContext* context, const v1::PullSessionRequest* request,
                           v1::PullSessionResponse* response);

 private:
  // Admits the call, has `make` add a session with its ControlBook to the table, and returns the session's status.
  template <class Request, class Response, class Make>
  grpc::Status Add(const grpc::CallbackServerContext& context, const Request& request, Response* response, Make make);
  // Admits the call and applies `act` to its session, once per request_id.
  template <class Request, class Response, class Act>
  grpc::Status Change(const grpc::CallbackServerContext& context, const Request& request, Response* response, Act act);

  session::Table& table_;
  AccessGuard& guard_;
  const PageTokens& page_tokens_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_SESSION_SERVICE_H_
