// The two steps that begin a call to a session: admit the caller, find the session.
#ifndef PHRENIC_SERVER_SERVICE_CALLS_SESSION_CALL_H_
#define PHRENIC_SERVER_SERVICE_CALLS_SESSION_CALL_H_

#include <grpcpp/server_context.h>

#include <memory>
#include <utility>

#include "absl/status/statusor.h"
#include "server/access/caller.h"
#include "server/service/calls/access_guard.h"
#include "server/session/table.h"

namespace phrenic::service {

// An admitted call. `session` is never null, and stays alive for the call even if another call deletes it; its methods
// then return the reason of its end.
struct SessionCall {
  access::Caller caller;
  std::shared_ptr<session::Session> session;
};

// Admits a call and finds the session that its request names. Thread-safe. Call it first, before anything of the
// session is read. It counts as attention to the session (Table::Tend), which keeps an idle session from being paused
// or deleted. Does not check control: Session's methods do, by the token.
// Errors: those of AccessGuard::Admit and of Table::Find.
template <class Request>
absl::StatusOr<SessionCall> AdmitToSession(AccessGuard& guard, const session::Table& table,
                                           const grpc::ServerContextBase& context, const Request& request) {
  auto caller = guard.Admit(context, request);
  if (!caller.ok()) return caller.status();
  auto session = table.Find(request.session_id());
  if (!session.ok()) return session.status();
  return SessionCall{*std::move(caller), *std::move(session)};
}

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_CALLS_SESSION_CALL_H_
